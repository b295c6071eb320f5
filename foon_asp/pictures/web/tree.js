// A list of steps, as JSON has it, as a picture: a card for each unit with what it takes from the kitchen
// and what nobody needs, and a box for every object that one step makes and another one takes.

const SVG = "http://www.w3.org/2000/svg";
const CARD = 206;
const PAD = 9;
const LINE = 15;

const ruler = document.createElement("canvas").getContext("2d");

function wrapped(text, width, font) {
  ruler.font = `${font} system-ui, -apple-system, "Segoe UI", "DejaVu Sans", Verdana, sans-serif`;
  const lines = [];
  let line = "";
  for (const word of text.split(/(?<=[\s,/-])/)) {
    if (line && ruler.measureText((line + word).trimEnd()).width > width) {
      lines.push(line.trimEnd());
      line = "";
    }
    line += word;
    while (line.length > 1 && ruler.measureText(line.trimEnd()).width > width) {
      let fits = line.length - 1;
      while (fits > 1 && ruler.measureText(line.slice(0, fits)).width > width) fits--;
      lines.push(line.slice(0, fits));
      line = line.slice(fits);
    }
  }
  if (line.trim() || !lines.length) lines.push(line.trimEnd());
  return lines;
}

function drawn(name, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

const keyOf = (node) => (node.id === null ? node.node : String(node.id));
const place = (node) => node.relations.map((each) => `${each.word} ${each.object}`);

// What of a list of ingredients came, and what went, against another one.
const changes = (ingredients, had) => [
  ...ingredients.filter((each) => !had.includes(each)).map((each) => `+ ${each}`),
  ...had.filter((each) => !ingredients.includes(each)).map((each) => `− ${each}`),
];

// The contents of a product in few words: what changed against the input that it was. That is one of the same name
// that the unit does not give back as it is, with the fewest changes; where two have as few, nothing says which.
function contentsOf(node, inputs, outputs) {
  const back = new Set(outputs.map(keyOf));
  const before = inputs.filter((input) => input.label === node.label && !back.has(keyOf(input)));
  return node.contents.map(({ word, ingredients }) => {
    const ways = before.flatMap((input) => input.contents.filter((c) => c.word === word)).map((c) => changes(ingredients, c.ingredients));
    const [first, second] = ways.sort((a, b) => a.length - b.length);
    if (first?.length && first.length < ingredients.length && first.length !== second?.length)
      return `${word} ${first.join(", ")}`;
    const shown = ingredients.length > 4 ? [...ingredients.slice(0, 3), `${ingredients.length - 3} more`] : ingredients;
    return `${word} ${shown.join(", ")}`;
  });
}

// ``step`` is the unit that makes the node, if it is shown as its product.
const details = (node, step = null) => [...node.states, ...place(node), ...contentsOf(node, step?.inputs ?? [], step?.outputs ?? [])].join(" · ");

// What is drawn of a list of steps: cards, objects and arrows, each with what it stands for.
class Plan {
  constructor(steps, goals) {
    this.steps = steps;
    this.goals = goals;
    this.goalKeys = new Set(goals.map(keyOf));
    this.taken = new Set();
    for (const step of steps)
      for (const input of step.inputs) {
        const from = input.from.step ?? input.from.later_step;
        if (from) this.taken.add(`${keyOf(input)}@${from}`);
      }
    this.made = new Map();
    for (const step of steps)
      for (const output of step.outputs)
        if (output.made && !this.made.has(keyOf(output))) this.made.set(keyOf(output), step.step);
    for (const goal of goals) {
      const maker = this.made.get(keyOf(goal));
      const last = steps.filter((s) => s.outputs.some((o) => o.made && keyOf(o) === keyOf(goal)));
      const taken = last.some((s) => this.taken.has(`${keyOf(goal)}@${s.step}`));
      if (maker) this.taken.add(`${keyOf(goal)}@${taken && last.length ? last[last.length - 1].step : maker}`);
    }
  }

  // Cards and objects with their sizes, and arrows between them.
  graph(leftovers) {
    const nodes = [];
    const arrows = [];
    for (const step of this.steps) {
      const id = `u${step.step}`;
      const rows = [];
      for (const input of step.inputs) {
        const { from } = input;
        const maker = from.step ?? from.later_step;
        if (maker) arrows.push({ from: `${keyOf(input)}@${maker}`, to: id, back: maker >= step.step });
        else rows.push(row(input, from.missing ? "lost" : from.implied ? "given" : from.bought ? "bought" : "kitchen"));
      }
      for (const output of step.outputs) {
        const object = `${keyOf(output)}@${step.step}`;
        if (this.taken.has(object)) {
          nodes.push(pill(object, output, step, this.goalKeys.has(keyOf(output))));
          arrows.push({ from: id, to: object });
        } else if (leftovers && !step.inputs.some((input) => keyOf(input) === keyOf(output))) rows.push(row(output, "left", step));
      }
      const height = 26 + rows.reduce((sum, each) => sum + each.h, 0) + (rows.length ? 8 : 0);
      nodes.push({ id, w: CARD, h: height, step, rows });
    }
    for (const goal of this.goals)
      if (!this.made.has(keyOf(goal))) nodes.push(pill(`${keyOf(goal)}@0`, goal, null, true));
    const there = new Set(nodes.map((node) => node.id));
    return { nodes, arrows: arrows.filter((arrow) => there.has(arrow.from)) };
  }

  at(object, step) {
    return this.steps[step - 1].outputs.find((output) => keyOf(output) === object);
  }
}

function row(node, kind, step = null) {
  const words = { lost: "missing", given: "taken as given", bought: "bought" };
  const name = wrapped(node.label, CARD - 34, "600 12px");
  const said = [details(node, step), words[kind]].filter(Boolean).join(" · ");
  const rest = said ? wrapped(said, CARD - 34, "11px") : [];
  return { node, kind, name, rest, h: (name.length + rest.length) * LINE + 3 };
}

function pill(id, node, step, goal) {
  const name = wrapped(node.label, 170, "600 12px");
  const said = details(node, step);
  const rest = said ? wrapped(said, 170, "11px") : [];
  ruler.font = '600 12px system-ui, sans-serif';
  const widest = Math.max(...[...name, ...rest].map((line) => ruler.measureText(line).width));
  return {
    id, node, goal, near: true, maker: step ? step.step : 0, name, rest,
    w: Math.min(196, Math.max(84, widest + 26)),
    h: (name.length + rest.length) * LINE + 10,
  };
}

// A picture of a plan that can be moved, zoomed, and walked through. ``picked`` is told what was clicked.
class Picture extends Movable {
  constructor(holder, plan, { label, picked, leftovers = true, marks = null }) {
    super(0.08, 4);
    this.plan = plan;
    this.picked = picked;
    this.marks = marks;
    this.leftovers = leftovers;
    this.content = drawn("g");
    this.svg = drawn("svg", { class: "picture", role: "img", "aria-label": label, tabindex: "0" }, this.content);
    holder.append(this.svg);
    this.draw();
    this.listen(this.svg);
    new ResizeObserver(() => this.sized()).observe(this.svg);
  }

  draw() {
    const { nodes, arrows } = this.plan.graph(this.leftovers);
    const placed = layered(nodes, arrows);
    this.size = { width: placed.width, height: placed.height };
    this.boxes = new Map();
    this.links = [];
    const lines = drawn("g");
    const tops = drawn("g");
    arrows.forEach((arrow, number) => {
      const points = placed.routes[number];
      const [x, y] = points.at(-1);
      const link = {
        arrow,
        element: drawn("path", { class: arrow.back ? "arrow back" : "arrow", d: arrow.back ? around(points) : curve(points) }),
        tip: drawn("path", { class: arrow.back ? "tip back" : "tip", d: arrow.back ? `M${x + 7},${y - 4}V${y + 4}L${x},${y}Z` : `M${x - 4},${y - 7}H${x + 4}L${x},${y}Z` }),
      };
      this.links.push(link);
      lines.append(link.element, link.tip);
    });
    for (const node of nodes) {
      const at = placed.boxes.get(node.id);
      const element = node.step ? this.card(node) : this.object(node);
      element.setAttribute("transform", `translate(${at.x - node.w / 2},${at.y - node.h / 2})`);
      element.dataset.id = node.id;
      tops.append(element);
      this.boxes.set(node.id, { node, element, x: at.x, y: at.y });
    }
    this.content.replaceChildren(lines, tops);
    this.show(this.step ?? 0);
    if (this.marks) this.mark(this.marks);
  }

  card(node) {
    const { step, rows } = node;
    const element = drawn("g", { class: "box unit" });
    element.append(
      drawn("rect", { class: "body", width: node.w, height: node.h, rx: 5 }),
      drawn("path", { class: "head", d: `M0,26V5Q0,0 5,0H${node.w - 5}Q${node.w},0 ${node.w},5V26Z` }),
    );
    const [title] = wrapped(step.step ? `${step.step}\u2002${step.motion}` : step.motion, node.w - 20, "650 13px");
    element.append(words(title, PAD, 18, "head-text"));
    element.append(drawn("title", {}, step.step ? `${step.step}. ${step.motion}` : step.motion));
    let y = 31;
    for (const each of rows) {
      const group = drawn("g", { class: `row ${each.kind}` });
      group.dataset.object = keyOf(each.node);
      group.append(drawn("rect", { class: "mark", x: PAD, y: y + 4, width: 9, height: 9, rx: 4.5 }));
      const lines = [...each.name.map((line) => [line, "name"]), ...each.rest.map((line) => [line, "detail"])];
      lines.forEach(([line, look], number) => group.append(words(line, PAD + 16, y + 12 + number * LINE, look)));
      group.append(drawn("title", {}, each.node.node));
      y += each.h;
      element.append(group);
    }
    return element;
  }

  object(node) {
    const element = drawn("g", { class: node.goal ? "box object goal" : "box object" });
    element.append(drawn("rect", { width: node.w, height: node.h, rx: Math.min(16, node.h / 2) }));
    const lines = [...node.name.map((line) => [line, "name"]), ...node.rest.map((line) => [line, "detail"])];
    lines.forEach(([line, look], number) => {
      const text = words(line, node.w / 2, 16 + number * LINE, look);
      text.setAttribute("text-anchor", "middle");
      element.append(text);
    });
    element.append(drawn("title", {}, node.node.node));
    return element;
  }

  // Shows the plan as it stands after a step: what comes later is faint. Before the first step it is shown whole.
  show(step) {
    this.step = step;
    for (const { node, element } of this.boxes.values()) {
      const when = node.step ? node.step.step : node.maker;
      element.classList.toggle("ahead", step > 0 && when > step);
      element.classList.toggle("now", Boolean(node.step) && when === step && step < this.plan.steps.length);
    }
    for (const { arrow, element, tip } of this.links) {
      const later = [arrow.from, arrow.to].some((id) => this.boxes.get(id).element.classList.contains("ahead"));
      element.classList.toggle("ahead", later);
      tip.classList.toggle("ahead", later);
    }
  }

  // Gives classes to boxes by their id, in place of those given before.
  mark(classes) {
    this.marks = classes;
    for (const [id, { element }] of this.boxes) {
      element.classList.remove("differs", "stuck", "inside", "crossing", "lost", "lacking");
      element.classList.add(...(classes.get(id) ?? []));
    }
  }

  choose(id) {
    for (const { element } of this.boxes.values()) element.classList.remove("chosen");
    this.boxes.get(id)?.element.classList.add("chosen");
  }

  click(target) {
    const box = target.closest?.(".box");
    if (!box) return;
    const { node } = this.boxes.get(box.dataset.id);
    const object = target.closest(".row")?.dataset.object;
    if (object !== undefined) this.picked({ object, step: node.step.step });
    else if (node.step) this.picked({ step: node.step.step });
    else this.picked({ object: keyOf(node.node), step: node.maker });
  }

  sized() {
    const { width, height } = this.svg.getBoundingClientRect();
    if (!width || !height) return;
    const first = !this.room;
    this.room = { width, height };
    if (first) this.fit();
    else this.moved();
  }

  // Shows it all; where that would be too small to read, and all is not asked for, what is at the top.
  fit(all = false) {
    const { width, height } = this.room ?? this.svg.getBoundingClientRect();
    const across = (width - 24) / this.size.width;
    let k = Math.min(across, (height - 24) / this.size.height, 1.15);
    const small = k < 0.42 && !all;
    if (small) k = Math.max(0.55, Math.min(across, 0.75));
    const wide = this.size.width * k > width;
    const top = [...this.boxes.values()].reduce((first, box) => (box.y < first.y ? box : first));
    this.view = {
      k,
      x: wide ? Math.min(12, Math.max(width - this.size.width * k - 12, width / 2 - top.x * k)) : (width - this.size.width * k) / 2,
      y: small ? 12 : (height - this.size.height * k) / 2,
    };
    this.moved();
  }

  moved() {
    const { x, y, k } = this.view;
    this.content.setAttribute("transform", `translate(${x},${y}) scale(${k})`);
  }

  // Moves a box into sight if it is out of it.
  reveal(id) {
    const box = this.boxes.get(id);
    if (!box || !this.room) return;
    const { x, y, k } = this.view;
    const [left, top] = [box.x * k + x, box.y * k + y];
    const { width, height } = this.room;
    if (left < 60 || left > width - 60) this.view.x += width / 2 - left;
    if (top < 60 || top > height - 60) this.view.y += height / 2 - top;
    this.moved();
  }

  // The whole picture as a file of its own, in light colours.
  file() {
    const { width, height } = this.size;
    const root = drawn("svg", { xmlns: SVG, viewBox: `-12 -12 ${width + 24} ${height + 24}`, width: width + 24, height: height + 24 });
    const style = drawn("style");
    const colours = new Map([...document.getElementById("light").textContent.matchAll(/(--[\w-]+):\s*([^;]+);/g)].map(([, name, value]) => [name, value]));
    style.textContent = document.getElementById("picture").textContent.replace(/var\((--[\w-]+)\)/g, (_, name) => colours.get(name));
    const content = this.content.cloneNode(true);
    content.removeAttribute("transform");
    root.append(style, drawn("rect", { x: -12, y: -12, width: width + 24, height: height + 24, fill: "#fff" }), content);
    return new XMLSerializer().serializeToString(root);
  }
}

function words(text, x, y, look) {
  const element = drawn("text", { x, y, class: look });
  element.textContent = text;
  return element;
}

// Leads an arrow that goes back up along the right side.
function around([[x1, y1], [x2, y2]]) {
  const far = Math.max(x1, x2) + Math.min(150, 50 + Math.abs(y2 - y1) / 5);
  return `M${x1},${y1}C${far},${y1} ${far},${y2} ${x2},${y2}`;
}

function curve(points) {
  let path = `M${points[0]}`;
  for (let i = 1; i < points.length; i++) {
    const [[x1, y1], [x2, y2]] = [points[i - 1], points[i]];
    const bow = Math.abs(y2 - y1) < 8 ? 40 : (y2 - y1) / 2;
    path += `C${x1},${y1 + bow} ${x2},${y2 - bow} ${x2},${y2}`;
  }
  return path;
}
