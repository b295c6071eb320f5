// The page: what is in the data, each part under a tab of its own. Text of the data is text, never markup.

const counted = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;
const figure = (value) => {
  if (value === null || value === undefined) return "–";
  if (typeof value === "number") return String(value);
  if (value.approx === null) return value.exact;
  const shown = String(+value.approx.toPrecision(4));
  return same(value.exact, shown) ? shown : `≈ ${shown}`;
};
// Whether a fraction is a decimal number, exactly.
function same(fraction, decimal) {
  const [above, below = "1"] = fraction.split("/");
  const parts = decimal.match(/^(-?\d+)(?:\.(\d+))?$/);
  if (!parts) return false;
  const [, whole, rest = ""] = parts;
  return BigInt(above) * 10n ** BigInt(rest.length) === BigInt(whole + rest) * BigInt(below);
}
const shortPlace = ({ file, line }) => `${file.split(/[\\/]/).pop()}:${line}`;
// A node in few words, which are all of it but for long contents.
const brief = (node, step = null) => {
  const rest = details(node, step);
  return [el("span", { class: "label" }, node.label), rest ? el("span", { class: "said" }, ` ${rest}`) : null];
};
// Whether items are used up, and so plans are asked for in place of trees.
const plans = () => data.answer?.items === "used-up";
const titleOf = (goals) => goals.map((goal) => goal.node).join(" + ");

function costsText(costs) {
  if (!costs) return "";
  const shown = [counted(costs.units, "unit"), counted(costs.inputs, "input")];
  if (costs.success) shown.push(`success ${figure(costs.success)}`);
  if (costs.price) shown.push(`price ${figure(costs.price)}`);
  return shown.join(" · ");
}

function claimOf(answer) {
  const by = answer.objectives.join(", then ");
  return {
    optimal: ["Proved best", ` by ${by}: ${costsText(answer.costs)}`],
    feasible: ["Not proved best", ` by ${by} (stopped at ${answer.stopped}): ${costsText(answer.costs)}`],
    infeasible: [`No ${answer.items === "used-up" ? "plan" : "tree"} exists`, ""],
    unknown: [`No ${answer.items === "used-up" ? "plan" : "tree"} found`, ` (stopped at ${answer.stopped})`],
  }[answer.status];
}

function sourceList(unit) {
  return unit.source.map((source) =>
    el("li", { title: source.file }, shortPlace(source), source.videos.length ? el("small", { class: "said" }, ` ${source.videos.join(", ")}`) : null));
}

// A tree with what one does with it: walk through it, choose in it, print it, save it.
class TreePanel {
  constructor(holder, { steps, goals, items = "lasting", label }) {
    this.steps = steps;
    this.plan = new Plan(steps, goals);
    this.items = items;
    this.stage = el("div", { class: "stage" });
    this.side = el("aside", { "aria-label": "The plan in words" });
    holder.append(this.stage, this.side);
    this.now = el("section", { "aria-live": "polite" });
    this.chosen = el("section", { hidden: true, "aria-live": "polite" });
    this.kitchen = el("details", { open: true });
    this.list = el("ol", { "aria-label": "Steps" });
    this.items_ = steps.map((step) => {
      const button = el("button", { class: "item", type: "button", click: () => { this.go(step.step); this.pick({ step: step.step }); } },
        el("span", { class: "number" }, `${step.step}.`), step.motion, " ",
        el("small", {}, this.newOf(step).map((node) => node.label).join(", ")));
      this.list.append(el("li", {}, button));
      return button;
    });
    this.side.append(this.now, this.chosen, this.kitchen, el("details", { open: true, class: "steps" }, el("summary", {}, `All ${counted(steps.length, "step")}`), this.list));
    const marks = [["motion", "unit"], ["kitchen", "from the kitchen"], ["made", "made on the way"], ["goal", "goal"]];
    this.side.append(el("div", { class: "legend" }, marks.map(([look, word]) => el("span", {}, el("i", { class: look }), word))));
    this.bar = this.controls();
    this.picture = new Picture(this.stage, this.plan, { label, picked: (what) => this.pick(what) });
    this.picture.svg.addEventListener("pointerover", ({ target }) => {
      this.left();
      this.rest = setTimeout(() => this.hover(target), 250);
    });
    this.picture.svg.addEventListener("pointerleave", () => this.left());
    this.tip = el("p", { class: "hint", role: "status", hidden: true });
    this.stage.append(this.tip, this.bar);
    this.go(0, false);
  }

  // What a step makes that was not there before.
  newOf(step) {
    if (this.items === "used-up") {
      const had = new Set(step.inputs.map(keyOf));
      return step.outputs.filter((output) => output.made && !had.has(keyOf(output)));
    }
    return step.outputs.filter((output) => output.made && this.plan.made.get(keyOf(output)) === step.step && !this.fromKitchen().has(keyOf(output)));
  }

  fromKitchen() {
    this.had ??= new Map(this.steps.flatMap((step) => step.inputs).filter((input) => input.from.kitchen || input.from.bought).map((input) => [keyOf(input), input]));
    return this.had;
  }

  controls() {
    const last = this.steps.length;
    const tool = (text, help, act) => el("button", { type: "button", title: help, "aria-label": help, click: act }, text);
    this.slider = el("input", { type: "range", min: 0, max: last, step: 1, "aria-label": "Step", input: () => this.go(Number(this.slider.value)) });
    this.said = el("output", {});
    this.player = tool("▶ Play", "Play the plan", () => this.play());
    const leftovers = el("button", { type: "button", "aria-pressed": "true", title: "Show what nobody needs", click: () => {
      this.picture.leftovers = !this.picture.leftovers;
      leftovers.setAttribute("aria-pressed", String(this.picture.leftovers));
      this.picture.draw();
      this.picture.fit();
    } }, "By-products");
    return el("div", { class: "bar" }, this.player,
      tool("◀", "One step back", () => this.go(this.step - 1)), tool("▶", "One step on", () => this.go(this.step + 1)),
      this.slider, this.said, leftovers,
      el("span", { class: "wide" }, tool("−", "Smaller", () => this.picture.zoom(0.8)), tool("+", "Larger", () => this.picture.zoom(1.25)), tool("Fit", "Show it all", () => this.picture.fit(true))),
      tool("SVG", "Save the picture as SVG", () => save(new Blob([this.picture.file()], { type: "image/svg+xml" }), "task-tree.svg")),
      el("span", { class: "wide" }, tool("Print", "Print the page", () => window.print())));
  }

  go(step, follow = true) {
    this.step = Math.min(this.steps.length, Math.max(0, step));
    this.slider.value = this.step;
    this.said.textContent = this.step ? `step ${this.step} of ${this.steps.length}` : "the start";
    this.slider.setAttribute("aria-valuetext", this.said.textContent);
    this.picture.show(this.step);
    if (follow) this.picture.reveal(`u${this.step}`);
    this.items_.forEach((button, place) => {
      if (place + 1 === this.step) button.setAttribute("aria-current", "step");
      else button.removeAttribute("aria-current");
    });
    this.tell();
  }

  play() {
    if (this.timer) return this.stop();
    if (this.step === this.steps.length) this.go(0);
    this.player.textContent = "■ Stop";
    this.timer = setInterval(() => {
      this.go(this.step + 1);
      if (this.step === this.steps.length) this.stop();
    }, 1200);
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.player.textContent = "▶ Play";
  }

  thing(node, look, step) {
    const maker = look === "plus" ? this.steps[step - 1] : null;
    const act = () => this.pick({ object: keyOf(node), step });
    return el("li", {}, el("button", { class: `item ${look}`, type: "button", title: node.node, click: act }, brief(node, maker)));
  }

  tell() {
    const step = this.steps[this.step - 1];
    const parts = [];
    if (!step) parts.push(el("h2", {}, "Before the first step"), el("p", { class: "said" }, "All that the plan uses from the kitchen is available."));
    else {
      parts.push(el("h2", {}, `Step ${step.step}: ${step.motion}`));
      const group = (name, nodes, look) => nodes.length ? [el("h3", {}, name), el("ul", {}, nodes.map((node) => this.thing(node, look, step.step)))] : [];
      const gone = step.inputs.filter((input) => input.stays === false);
      parts.push(...group("uses", step.inputs.filter((input) => input.stays !== false), "took"));
      parts.push(...group("uses up", gone, "minus"), ...group("makes", this.newOf(step), "plus"));
    }
    this.now.replaceChildren(...parts);
    const there = this.there();
    this.kitchen.replaceChildren(
      el("summary", {}, `Kitchen after ${this.step ? `step ${this.step}` : "no step"}: ${counted(there.length, "object")}`),
      this.items === "lasting" ? el("p", { class: "said" }, "Nothing runs out: all available items stay. Only items that the plan uses are listed.")
        : el("p", { class: "said" }, "Items that are used up are gone. Items that the plan uses from the kitchen are listed as at the start."),
      el("ul", {}, there.map(({ node, copies, came }) => {
        const item = this.thing(node, came ? "plus" : "", this.step);
        if (copies > 1) item.firstChild.append(el("small", {}, ` × ${copies}`));
        return item;
      })));
  }

  // What is there after the step that is shown, what came last first.
  there() {
    const step = this.steps[this.step - 1];
    const came = new Set(step ? this.newOf(step).map(keyOf) : []);
    const found = new Map();
    const done = this.steps.slice(0, this.step);
    const used = done.flatMap((each) => each.inputs).filter((input) => input.stays === false);
    for (const each of done.reverse())
      for (const node of this.newOf(each)) {
        const gone = used.some((input) => keyOf(input) === keyOf(node) && input.from.step === each.step);
        if (gone) continue;
        const key = keyOf(node);
        if (found.has(key)) found.get(key).copies++;
        else found.set(key, { node, copies: 1, came: came.has(key) });
      }
    for (const [key, node] of this.fromKitchen()) if (!found.has(key)) found.set(key, { node });
    return [...found.values()];
  }

  // Shows who makes and needs an object, or what a unit is; of an object as it is after a step.
  pick({ object, step }) {
    const unit = this.steps[step - 1];
    let parts;
    if (object === undefined) {
      this.picture.choose(`u${step}`);
      const rate = data.rates?.find((each) => each.unit === unit.id)?.rate;
      parts = [el("h2", {}, `Unit ${unit.id}: ${unit.motion}`), el("dl", {},
        el("dt", {}, "step"), el("dd", {}, String(step)),
        rate ? [el("dt", {}, "rate"), el("dd", {}, figure(rate))] : null,
        el("dt", {}, "read at"), el("dd", {}, el("ul", {}, sourceList(unit)))),
        el("h3", {}, "uses"), el("ul", {}, unit.inputs.map((node) => this.thing(node, "took", step))),
        el("h3", {}, "makes"), el("ul", {}, unit.outputs.map((node) => this.thing(node, node.made ? "plus" : "", step)))];
    } else {
      const makers = this.steps.filter((each) => each.outputs.some((node) => node.made && keyOf(node) === object));
      const needers = this.steps.filter((each) => each.inputs.some((node) => keyOf(node) === object));
      const node = [...this.steps.flatMap((each) => [...each.inputs, ...each.outputs]), ...this.plan.goals].find((each) => keyOf(each) === object);
      const drawnAt = [step, ...makers.map((each) => each.step)].map((at) => `${object}@${at}`).find((id) => this.picture.boxes.has(id));
      this.picture.choose(drawnAt ?? `u${step}`);
      const steps = (list) => el("ul", {}, list.map((each) => el("li", {}, el("button", { class: "item", type: "button", click: () => { this.pick({ step: each.step }); this.picture.reveal(`u${each.step}`); } }, `step ${each.step}: ${each.motion}`))));
      parts = [el("h2", {}, node.node),
        el("h3", {}, "made by"), makers.length ? steps(makers) : el("p", {}, this.fromKitchen().has(object) ? "the kitchen has it" : "nobody in this tree"),
        el("h3", {}, "needed by"), needers.length ? steps(needers) : el("p", {}, this.plan.goalKeys.has(object) ? "it is the goal" : "nobody: a by-product"),
        el("h3", {}, "read at"), el("ul", {}, [...makers, ...needers].slice(0, 6).flatMap(sourceList))];
    }
    this.chosen.replaceChildren(...parts, el("button", { type: "button", class: "tool no-print", click: () => { this.chosen.hidden = true; this.picture.choose(""); } }, "Close"));
    this.chosen.hidden = false;
    const kitchen = object !== undefined && this.fromKitchen().get(object);
    if (object === undefined || kitchen) this.ask(object === undefined ? { unit: unit.id } : { item: kitchen.node });
  }

  // Lets who shows this page say more about what was chosen.
  ask(what) {
    const said = el("p", {});
    this.chosen.children[0].after(said);
    askAbout(what, (text) => { said.textContent = text; });
  }

  // What the mouse rests on is asked about, too; what is said stands where its name is shown.
  hover(target) {
    const [box, row] = [target.closest(".box"), target.closest(".row")];
    const unit = box && this.picture.boxes.get(box.dataset.id).node.step;
    const item = row && this.fromKitchen().get(row.dataset.object);
    const holder = row ?? box;
    if (!unit || (row && !item)) return;
    this.over = holder;
    if (holder.dataset.said !== undefined) return this.hint(holder);
    holder.dataset.said = "";
    const title = holder.querySelector(":scope > title");
    const name = title.textContent;
    askAbout(item ? { item: item.node } : { unit: unit.id }, (text) => {
      title.textContent = text ? `${name}\n${text}` : name;
      holder.dataset.said = text ? title.textContent : "";
      if (this.over === holder) this.hint(holder);
      if (!text) delete holder.dataset.said;
    });
  }

  // Shows what was answered about what the pointer rests on, until it goes on.
  hint({ dataset }) {
    this.tip.textContent = dataset.said;
    this.tip.hidden = !dataset.said;
  }

  left() {
    clearTimeout(this.rest);
    this.over = null;
    this.tip.hidden = true;
  }
}

const askAbout = (what, say) => document.dispatchEvent(new CustomEvent("picked", { detail: { ...what, say } }));

function save(blob, name) {
  const link = el("a", { download: name });
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// The whole picture is on paper, not the part that is seen.
function printable(panels) {
  window.addEventListener("beforeprint", () => panels.forEach((picture) => {
    const { width, height } = picture.size;
    picture.svg.setAttribute("viewBox", `-8 -8 ${width + 16} ${height + 16}`);
    picture.content.removeAttribute("transform");
  }));
  window.addEventListener("afterprint", () => panels.forEach((picture) => {
    picture.svg.removeAttribute("viewBox");
    picture.moved();
  }));
}

const TABS = [];  // [name, whether the data have it, what fills the panel]

TABS.push(["Tree", () => Boolean(data.answer?.units?.length), (panel) => {
  const { answer } = data;
  const shown = new TreePanel(panel, { steps: answer.units, goals: answer.goals, items: answer.items, label: `Task tree for ${titleOf(answer.goals)}` });
  printable([shown.picture]);
  document.addEventListener("keydown", (event) => {
    if (panel.hidden || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || event.defaultPrevented) return;
    if (event.target.matches?.("input, select, textarea, [role=tab]")) return;
    if (event.key === "ArrowRight") shown.go(shown.step + 1);
    else if (event.key === "ArrowLeft") shown.go(shown.step - 1);
    else if (event.key === "Home") shown.go(0);
    else if (event.key === "End") shown.go(shown.steps.length);
    else return;
    event.preventDefault();
  });
}]);

function start() {
  const header = el("header");
  const goals = data.answer?.goals ?? [];
  const name = (goal) => [el("span", { title: goal.node }, goal.label), el("small", {}, ` ${details(goal)}`)];
  header.append(el("h1", {}, goals.length ? goals.flatMap((goal, place) => (place ? [" + ", ...name(goal)] : name(goal))) : [`${counted(data.network.units.length, "functional unit")}, ${counted(data.network.objects.length, "object node")}`]));
  if (data.answer) {
    const [claim, rest] = claimOf(data.answer);
    const rules = `${data.answer.containers} containers${data.answer.items === "used-up" ? ", items used up" : ""}`;
    header.append(el("p", { class: data.answer.status === "optimal" ? "claim" : "claim open" }, el("strong", {}, claim), `${rest} (${rules})`));
    const lack = data.answer.used_up?.shortage;
    if (lack) {
      const [where, by] = [lack.position ? `step ${lack.position}` : "the end", lack.used_up_by.join(", ")];
      header.append(el("p", { class: "claim open" }, `With each item used once, ${where} lacks ${lack.missing.node}, used up by step ${by}: see --items used-up`));
    }
  }
  const list = el("div", { role: "tablist", "aria-label": "Parts of the page" });
  header.append(list);
  const main = TABS.filter(([, has]) => has()).map(([name, , fill], place) => {
    const panel = el("main", { role: "tabpanel", id: `panel${place}`, "aria-labelledby": `tab${place}`, hidden: true });
    const tab = el("button", { role: "tab", type: "button", id: `tab${place}`, "aria-controls": `panel${place}`, click: () => open(place) }, name);
    list.append(tab);
    return { tab, panel, fill };
  });
  document.body.append(header, ...main.map(({ panel }) => panel));
  const open = (place) => main.forEach((each, number) => {
    const here = number === place;
    each.tab.setAttribute("aria-selected", String(here));
    each.tab.tabIndex = here ? 0 : -1;
    each.panel.hidden = !here;
    if (here && each.fill) {
      each.fill(each.panel);
      each.fill = null;
    }
  });
  list.addEventListener("keydown", (event) => {
    const at = main.findIndex(({ tab }) => tab === document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: main.length - 1 }[event.key];
    if (to === undefined || !main[to]) return;
    open(to);
    main[to].tab.focus();
    event.preventDefault();
  });
  if (main.length) open(0);
  else document.body.append(el("main", { class: "empty" }, el("p", {}, data.answer.units ? "Nothing needs to be made: the kitchen has the goal." : "There is no tree to show.")));
}
