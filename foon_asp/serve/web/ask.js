// The interactive page: a form with the question on the left, and the page of the answer on the right.

const { first } = data;
const body = (value) => ({ method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(value) });

// Hands each line of an answer to a function as it comes, after telling that it has begun.
async function told(where, question, tell, begun = () => {}) {
  const response = await fetch(where, body(question));
  begun();
  if (!response.ok) return tell({ kind: "error", text: await response.text(), places: [] });
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return undefined;
    const lines = (rest + value).split("\n");
    rest = lines.pop();
    for (const line of lines) tell(JSON.parse(line, (_, each) => typeof each === "string" ? each.replace(UNSEEN, "\ufffd") : each));
  }
}

// A field in which names of object nodes are completed. A name that was completed is taken at once, any other
// one where Enter is pressed.
let fields = 0;
function nameField(label, taken, known = []) {
  const list = el("datalist", { id: `names${fields++}` });
  let asked = 0;
  const input = el("input", { type: "search", list: list.id, "aria-label": label, placeholder: label, autocomplete: "off",
    input: async () => {
      const turn = ++asked;
      const start = input.value;
      const found = start ? await (await fetch(`names?start=${encodeURIComponent(start)}`)).json() : [];
      const names = [...known.filter((name) => name.startsWith(start)), ...found];
      if (turn === asked) list.replaceChildren(...[...new Set(names)].map((name) => el("option", { value: name })));
    },
    keydown: (event) => { if (event.key === "Enter") { event.preventDefault(); take(); } },
    change: () => { if ([...list.options].some((each) => each.value === input.value)) take(); } });
  const take = () => {
    const name = input.value.trim();
    if (name) taken(name);
    input.value = "";
  };
  list.append(...known.map((name) => el("option", { value: name })));
  return { input, take, parts: [input, list] };
}

// A list of names, each with a button that takes it away.
function chips(label, names) {
  const list = el("ul", { class: "chips", "aria-label": label });
  const show = () => list.replaceChildren(...names.map((name) => el("li", {}, el("span", {}, name),
    el("button", { type: "button", title: "Remove", "aria-label": `Remove ${name}`, click: () => { names.splice(names.indexOf(name), 1); show(); } }, "✕"))));
  show();
  return { list, add: (name) => { if (!names.includes(name)) names.push(name); show(); } };
}

const select = (label, options, value) => el("select", { "aria-label": label }, options.map(([name, text]) =>
  el("option", { value: name, selected: name === value }, text ?? name)));
const group = (name, ...parts) => el("fieldset", {}, el("legend", {}, name), ...parts);
const tick = (name, checked, change) => el("label", { class: "line" }, el("input", { type: "checkbox", value: name, checked, ...(change ? { change } : {}) }), el("span", {}, name));
const ticked = (holder, on = true) => [...holder.querySelectorAll("input")].filter((each) => each.checked === on).map((each) => each.value);

const goals = [...first.goals];
const goalChips = chips("Goals", goals);
const goalField = nameField("Name a goal", goalChips.add, data.goals);

const objectives = [...first.objectives];
const objectiveChips = chips("Objectives, the most important first", objectives);
const more = select("Add an objective", [["", "add an objective …"], ...data.objectives.map((name) => [name])], "");
more.addEventListener("change", () => { if (more.value) objectiveChips.add(more.value); more.value = ""; });

const containers = select("Container rule", [["strict"], ["implied"]], first.containers);
const items = select("Items", [["lasting"], ["used-up", "used up"]], first.items);

const had = new Set(data.kitchen);
const kitchen = el("div", { class: "many", role: "group", "aria-label": "What the kitchen has" }, data.kitchen.map((name) => tick(name, true)));
const kitchenField = nameField("Find, or add to the kitchen", (name) => {
  const line = [...kitchen.children].find((each) => each.textContent === name);
  if (line) line.querySelector("input").checked = true;
  else kitchen.prepend(tick(name, true));
  find("");
});
const find = (start) => [...kitchen.children].forEach((each) => { each.hidden = !each.textContent.includes(start); });
kitchenField.input.addEventListener("input", () => find(kitchenField.input.value));

const wrong = el("ul", { class: "bad told", id: "wrong", role: "alert" });
const rules = el("textarea", { "aria-label": "Rules", spellcheck: "false", "aria-describedby": "wrong", placeholder: ":- use(U), motion(U,\"fry\").", input: () => marked([]) });
rules.value = first.rules;

// Where in the rules something is wrong: in words under them, and chosen in them.
function marked(places) {
  wrong.replaceChildren(...places.map(({ line, column, text }) => el("li", {},
    el("button", { type: "button", class: "item", click: () => goTo(line, column) }, `line ${line}, column ${column}: ${text}`))));
  if (!places.length) return rules.removeAttribute("aria-invalid");
  rules.setAttribute("aria-invalid", "true");
  return goTo(places[0].line, places[0].column);
}

function goTo(line, column) {
  const before = rules.value.split("\n").slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0);
  const at = before + [...rules.value.slice(before)].slice(0, column - 1).join("").length;
  rules.focus();
  rules.setSelectionRange(at, Math.min(at + 1, rules.value.length));
}

const beside = el("div", {}, data.beside.map((name) => tick(name, first.beside.includes(name))));
const status = el("p", { class: "told", role: "status" });
const asks = el("button", { type: "button", class: "tool main", click: () => ask() }, "Ask");
const stops = el("button", { type: "button", class: "tool", disabled: true, click: () => fetch("cancel", body({})) }, "Cancel");
const frame = el("iframe", { title: "The answer" });
const newer = el("button", { type: "button", class: "tool", hidden: true, click: () => open(latest) }, "Show the new answer");
let latest = 0;
let shown = 0;
let touched = false;  // whether somebody is at work on the page that is shown
let turn = 0;
let busy = false;  // whether something is being answered

document.body.append(
  el("main", { class: "form" }, el("h1", {}, "Question"),
    group("Goals", goalChips.list, ...goalField.parts),
    group("Objective", objectiveChips.list, more),
    el("div", { class: "pair" }, group("Containers", containers), group("Items", items)),
    group("Kitchen", ...kitchenField.parts, kitchen),
    group("Rules", rules, wrong),
    ...(data.always.length ? [group("In every question", el("ul", { class: "said" }, data.always.map((each) => el("li", {}, each))))] : []),
    group("Also show", beside),
    el("div", { class: "acts" }, asks, stops), status, newer),
  frame);

async function ask() {
  const now = ++turn;
  goalField.take();
  marked([]);
  status.textContent = "asking …";
  status.className = "told";
  touched = false;
  busy = true;
  let said = "";
  const on = ticked(kitchen);
  await told("ask", {
    goals, objectives, containers: containers.value, items: items.value, rules: rules.value, beside: ticked(beside),
    adding: on.filter((name) => !had.has(name)), without: ticked(kitchen, false).filter((name) => had.has(name)),
  }, (event) => {
    if (now !== turn) return;
    if (event.kind === "page") {
      latest = event.number;
      if (touched) newer.hidden = false;
      else open(latest);
      said = event.text;
      status.textContent = said;
    } else if (event.kind === "error") {
      status.className = "told bad";
      status.textContent = event.places.length ? "the rules cannot be read" : event.text;
      said = status.textContent;
      marked(event.places);
    } else status.textContent = event.text;
  }, () => { if (now === turn) stops.disabled = false; }).catch((error) => { said = `the server does not answer: ${error.message}`; });
  if (now !== turn) return;
  status.textContent = said;
  stops.disabled = true;
  busy = false;
}

function open(page) {
  shown = page;
  touched = false;
  newer.hidden = true;
  frame.src = `page/${page}`;
  if (matchMedia("(max-width: 760px)").matches) frame.scrollIntoView();
}

// What was chosen in the answer is asked about: what is the best without it?
frame.addEventListener("load", () => {
  const page = shown;
  for (const act of ["pointerdown", "keydown"]) frame.contentDocument?.addEventListener(act, () => { touched = true; });
  frame.contentDocument?.addEventListener("picked", ({ detail: { say, ...what } }) => {
    if (busy) return say("");  // it would end what is being answered
    say("Without it: …");
    const tell = ({ text }) => say(text === "cancelled" ? "" : `Without it: ${text}`);  // by the next one
    return told("without", { page, ...what }, tell).catch(() => say(""));
  });
});

if (goals.length) ask();
