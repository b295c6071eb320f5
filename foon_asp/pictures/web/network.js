// The whole network on a canvas: every unit a square, every object a circle, at places that came with the data.

// Colours of recipes, as different from each other as possible, as many as there are.
const hue = (place) => `hsl(${(210 + place * 137.508) % 360} ${58 + (place % 3) * 12}% ${44 + (place % 2) * 9}%)`;
const MARGIN = 0.5;  // of the window, drawn beside it, so that moving it shows no edge

class Graph {
  constructor({ objects, units, places, kitchen, reachable, possible }) {
    this.units = units;
    this.objects = objects;
    const count = units.length + objects.length;
    this.x = new Float32Array(count);
    this.y = new Float32Array(count);
    for (let i = 0; i < count; i++) [this.x[i], this.y[i]] = [places[2 * i], places[2 * i + 1]];
    this.near = Array.from({ length: count }, () => []);
    this.arrows = [];
    units.forEach((unit, u) => {
      for (const o of unit.inputs) this.arrows.push([units.length + o, u]);
      for (const o of unit.outputs) this.arrows.push([u, units.length + o]);
    });
    for (const [a, b] of this.arrows) {
      this.near[a].push(b);
      this.near[b].push(a);
    }
    this.kitchen = new Set(kitchen);
    this.reachable = new Set(reachable);
    this.possible = new Set(possible);
    this.group();
  }

  get count() { return this.x.length; }
  isUnit(i) { return i < this.units.length; }
  object(i) { return this.objects[i - this.units.length]; }
  name(i) { return this.isUnit(i) ? this.units[i].motion : this.object(i).label; }

  // Gives every unit its recipe: the video or the file it was read from. Where there is but one, parts that hang
  // together take its place.
  group() {
    const recipe = this.units.map((unit) => unit.source[0]?.videos[0] ?? unit.source[0]?.file ?? "");
    this.named = new Set(recipe).size > 1;
    const parts = this.named ? recipe : this.parts();
    const members = new Map();
    parts.forEach((part, u) => members.set(part, [...(members.get(part) ?? []), u]));
    const largest = [...members].sort(([, a], [, b]) => b.length - a.length || a[0] - b[0]);
    this.groups = largest.map(([part, units]) => ({ name: this.named ? String(part).split(/[\\/]/).pop() : this.partName(units), units }));
    this.groupOf = new Int32Array(this.units.length);
    this.groups.forEach((group, place) => group.units.forEach((u) => (this.groupOf[u] = place)));
    this.shared = this.objects.map((_, o) => new Set(this.near[this.units.length + o].map((u) => this.groupOf[u])).size > 1);
  }

  // Each unit joins the part that most of what it shares with others belongs to; common objects count little.
  parts() {
    const part = this.units.map((_, u) => u);
    for (let round = 0; round < 8; round++)
      for (let u = 0; u < this.units.length; u++) {
        const weights = new Map();
        for (const o of this.near[u]) {
          const users = this.near[o];
          if (users.length > 10) continue;
          for (const other of users) if (other !== u) weights.set(part[other], (weights.get(part[other]) ?? 0) + 1 / users.length);
        }
        let best = weights.get(part[u]) ?? 0;
        for (const [label, weight] of weights) if (weight > best + 1e-9) { best = weight; part[u] = label; }
      }
    return part;
  }

  partName(units) {
    const inside = new Set(units);
    this.places ??= new Set(this.objects.flatMap((node) => node.relations.map((each) => each.object)));
    const counts = new Map();
    for (const u of units)
      for (const o of this.units[u].outputs) {
        const { label } = this.objects[o];
        const last = !this.near[this.units.length + o].some((other) => other !== u && inside.has(other));
        counts.set(label, (counts.get(label) ?? 0) + (this.places.has(label) ? 0.01 : last ? 1.5 : 1));
      }
    return [...counts].sort(([a, n], [b, m]) => m - n || (a < b ? -1 : 1))[0]?.[0] ?? "";
  }

  // What can be reached over so many arrows, whichever way they lead.
  around(start, depth) {
    const found = new Set([start]);
    let edge = [start];
    for (let far = 0; far < depth && edge.length; far++) {
      const next = [];
      for (const i of edge) for (const j of this.near[i]) if (!found.has(j)) { found.add(j); next.push(j); }
      edge = next;
    }
    return found;
  }
}

class NetworkPanel extends Movable {
  constructor(panel) {
    super(0.02, 6);
    this.graph = new Graph(data.network);
    const { graph } = this;
    this.canvas = el("canvas", { class: "canvas", tabindex: "0", role: "img", "aria-label": `${counted(graph.units.length, "unit")} and ${counted(graph.objects.length, "object node")}` });
    this.chosen = null;
    this.depth = 1;
    this.mode = graph.named ? "recipes" : "kinds";
    this.lit = null;
    const holder = el("div", { class: "canvas-holder" }, this.canvas);
    const tool = (text, help, act) => el("button", { type: "button", title: help, "aria-label": help, click: act }, text);
    const modes = [["recipes", graph.named ? "recipes" : "parts that hang together"], ["reach", "kitchen and what can be made"], ["kinds", "units and objects"]];
    if (data.answer?.units?.length) modes.push(["tree", "the tree in the network"]);
    this.cuts = (data.proof?.cases.length === 1 ? data.proof.cases[0].cuts : []).filter((cut) => cut.weight !== null);
    if (this.cuts.length) modes.push(["cuts", "the cuts of the proof"]);
    this.cutRange = el("input", { type: "range", min: 1, max: this.cuts.length, value: 1, step: 1, "aria-label": "Cut", input: () => this.light() });
    this.cut = el("label", { class: "far" }, "cut ", this.cutRange);
    const select = el("select", { "aria-label": "Colours", change: () => { this.mode = select.value; this.light(); this.legend(); } }, modes.map(([value, name]) => el("option", { value, selected: value === this.mode }, name)));
    this.range = el("input", { type: "range", min: 0, max: 8, value: 1, step: 1, "aria-label": "How far around the chosen node", input: () => { this.depth = Number(this.range.value); this.light(); } });
    this.said = el("output", {});
    this.far = el("label", { class: "far" }, "neighbours up to ", this.range);
    const bar = el("div", { class: "bar" }, select, this.far, this.cut, this.said, el("span", { class: "gap" }),
      tool("−", "Smaller", () => this.zoom(0.8)), tool("+", "Larger", () => this.zoom(1.25)), tool("Fit", "Show it all", () => this.fit()),
      tool("PNG", "Save what is seen as PNG", () => this.canvas.toBlob((blob) => save(blob, "network.png"))));
    this.side = el("aside", { "aria-label": "The network in words" });
    panel.append(el("div", { class: "stage" }, holder, bar), this.side);
    this.search = el("input", { type: "search", "aria-label": "Search by name", placeholder: "Search by name", class: "tool", input: () => this.find() });
    this.results = el("ul", { "aria-label": "Found" });
    this.details = el("section", { "aria-live": "polite", hidden: true });
    this.key = el("section", {});
    const shared = graph.shared.filter(Boolean).length;
    this.side.append(el("section", {}, this.search, this.results), this.details, this.key,
      el("p", { class: "said" }, `${counted(graph.units.length, "unit")}, ${counted(graph.objects.length, "object node")}, of which ${shared} are shared by several ${graph.named ? "recipes" : "parts"} (with a dark rim in that colouring), ${graph.kitchen.size} are in the kitchen, and ${graph.reachable.size} are there or can be made.`));
    this.listen(this.canvas);
    this.dark = window.matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.paint());
    new ResizeObserver(() => this.sized()).observe(this.canvas);
    this.hubs = Array.from({ length: graph.count }, (_, i) => i).filter((i) => !graph.isUnit(i))
      .sort((a, b) => graph.near[b].length - graph.near[a].length || a - b);
    this.legend();
    this.light();
  }

  sized() {
    const { width, height } = this.canvas.getBoundingClientRect();
    if (!width || !height) return;
    const first = !this.room;
    const sharp = window.devicePixelRatio || 1;
    this.room = { width, height, sharp };
    this.canvas.width = Math.round(width * sharp);
    this.canvas.height = Math.round(height * sharp);
    if (first) this.fit();
    else this.paint();
  }

  fit() {
    if (!this.room) return;
    const { width, height } = this.room;
    const { x, y } = this.graph;
    let [right, bottom] = [1, 1];
    for (let i = 0; i < x.length; i++) { right = Math.max(right, x[i]); bottom = Math.max(bottom, y[i]); }
    const k = Math.min((width - 30) / right, (height - 30) / bottom, 3);
    this.view = { k, x: (width - right * k) / 2, y: (height - bottom * k) / 2 };
    this.paint();
  }

  // Moving shows the picture that is there, elsewhere or larger; it is painted anew once that rests.
  moved() {
    this.asked ??= requestAnimationFrame(() => { this.asked = null; this.reuse(); });
    clearTimeout(this.rest);
    this.rest = setTimeout(() => this.paint(), 140);
  }

  reuse() {
    if (!this.kept) return this.paint();
    const { width, height, sharp } = this.room;
    const { view, kept } = this;
    const scale = view.k / kept.k;
    const [left, top] = [view.x - kept.x * scale - width * MARGIN * scale, view.y - kept.y * scale - height * MARGIN * scale];
    const wide = width * (1 + 2 * MARGIN) * scale;
    const high = height * (1 + 2 * MARGIN) * scale;
    if (scale < 0.5 || scale > 2.5 || left > 0 || top > 0 || left + wide < width || top + high < height) return this.paint();
    const pen = this.canvas.getContext("2d");
    pen.setTransform(sharp, 0, 0, sharp, 0, 0);
    pen.fillStyle = this.colour("--card");
    pen.fillRect(0, 0, width, height);
    pen.drawImage(kept.picture, left, top, wide, high);
  }

  paint() {
    if (!this.room) return;
    const { width, height, sharp } = this.room;
    const picture = this.kept?.picture ?? document.createElement("canvas");
    const [wide, high] = [Math.round(width * (1 + 2 * MARGIN) * sharp), Math.round(height * (1 + 2 * MARGIN) * sharp)];
    if (picture.width !== wide || picture.height !== high) [picture.width, picture.height] = [wide, high];
    const pen = picture.getContext("2d");
    pen.setTransform(sharp, 0, 0, sharp, width * MARGIN * sharp, height * MARGIN * sharp);
    pen.fillStyle = this.colour("--card");
    pen.fillRect(-width * MARGIN, -height * MARGIN, width * (1 + 2 * MARGIN), height * (1 + 2 * MARGIN));
    this.put(pen, width, height);
    this.kept = { picture, ...this.view };
    this.reuse();
  }

  put(pen, width, height) {
    const { graph, view: { x: dx, y: dy, k }, lit } = this;
    const px = (i) => graph.x[i] * k + dx;
    const py = (i) => graph.y[i] * k + dy;
    const seen = (i) => px(i) > -width * MARGIN && px(i) < width * (1 + MARGIN) && py(i) > -height * MARGIN && py(i) < height * (1 + MARGIN);
    const rules = [[this.colour("--line"), lit ? 0.05 : Math.min(0.5, 0.16 + k / 3), (a, b) => !lit || !(lit.has(a) && lit.has(b))]];
    if (lit) rules.push([this.colour("--ink"), 0.75, (a, b) => lit.has(a) && lit.has(b)]);
    for (const [stroke, alpha, wanted] of rules) {
      pen.globalAlpha = alpha;
      pen.strokeStyle = stroke;
      pen.lineWidth = lit && alpha > 0.5 ? 1.3 : 0.8;
      pen.beginPath();
      for (const [a, b] of graph.arrows)
        if (wanted(a, b) && (seen(a) || seen(b))) {
          pen.moveTo(px(a), py(a));
          pen.lineTo(px(b), py(b));
        }
      pen.stroke();
    }
    const size = Math.min(9, Math.max(1.6, 7 * k + 1));
    const buckets = new Map();
    for (let i = 0; i < graph.count; i++)
      if (seen(i)) {
        const fill = `${lit && !lit.has(i) ? 0.12 : 1}|${this.fill(i)}`;
        if (!buckets.has(fill)) buckets.set(fill, []);
        buckets.get(fill).push(i);
      }
    for (const [look, nodes] of [...buckets].sort(([a], [b]) => (a < b ? -1 : 1))) {
      const [alpha, fill] = look.split("|");
      pen.globalAlpha = Number(alpha);
      pen.fillStyle = fill;
      pen.beginPath();
      for (const i of nodes) {
        const r = this.radius(i, size);
        if (graph.isUnit(i)) pen.rect(px(i) - r, py(i) - r, 2 * r, 2 * r);
        else {
          pen.moveTo(px(i) + r, py(i));
          pen.arc(px(i), py(i), r, 0, 2 * Math.PI);
        }
      }
      pen.fill();
    }
    pen.strokeStyle = this.colour("--ink");
    pen.lineWidth = 1;
    pen.globalAlpha = 0.85;
    pen.beginPath();
    for (let o = 0; o < graph.objects.length; o++) {
      const i = graph.units.length + o;
      if (!graph.shared[o] || this.mode !== "recipes" || (lit && !lit.has(i)) || !seen(i)) continue;
      const r = this.radius(i, size);
      pen.moveTo(px(i) + r, py(i));
      pen.arc(px(i), py(i), r, 0, 2 * Math.PI);
    }
    pen.stroke();
    pen.globalAlpha = 1;
    this.labels(pen, px, py, size, seen);
    if (this.chosen !== null) {
      pen.strokeStyle = this.colour("--focus");
      pen.lineWidth = 3;
      pen.beginPath();
      pen.arc(px(this.chosen), py(this.chosen), this.radius(this.chosen, size) + 5, 0, 2 * Math.PI);
      pen.stroke();
    }
  }

  radius(i, size) {
    return this.graph.isUnit(i) ? size * 0.8 : size * (1 + Math.min(1.2, this.graph.near[i].length / 60));
  }

  // Names of what is lit, or of what most meets in; all of them once there is room. None lies on another.
  labels(pen, px, py, size, seen) {
    const { graph, lit } = this;
    const taken = [];
    const many = size > 5 ? graph.count : 26;
    const wanted = lit && lit.size < 400 ? [...lit] : [...this.hubs.slice(0, many), ...(size > 6 ? graph.units.keys() : [])];
    if (this.chosen !== null) wanted.unshift(this.chosen);
    pen.font = '11px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif';
    pen.textAlign = "center";
    pen.lineJoin = "round";
    for (const i of wanted) {
      if (!seen(i) || taken.length > 220) continue;
      const name = graph.name(i);
      const [x, y] = [px(i), py(i) - this.radius(i, size) - 4];
      const half = pen.measureText(name).width / 2 + 3;
      if (taken.some(([l, t, r, b]) => x + half > l && x - half < r && y + 3 > t && y - 11 < b)) continue;
      taken.push([x - half, y - 11, x + half, y + 3]);
      pen.strokeStyle = this.colour("--card");
      pen.lineWidth = 3.5;
      pen.strokeText(name, x, y);
      pen.fillStyle = this.colour("--ink");
      pen.fillText(name, x, y);
    }
  }

  fill(i) {
    const { graph } = this;
    if (this.mode === "reach") {
      if (graph.isUnit(i)) return graph.possible.has(i) ? this.colour("--motion") : this.colour("--rule");
      const o = i - graph.units.length;
      return graph.kitchen.has(o) ? this.colour("--goal") : graph.reachable.has(o) ? this.colour("--object-line") : this.colour("--rule");
    }
    if (this.mode === "recipes") {
      const group = graph.isUnit(i) ? graph.groupOf[i] : graph.near[i].length ? graph.groupOf[graph.near[i][0]] : -1;
      return group < 0 ? this.colour("--line") : hue(group);
    }
    return graph.isUnit(i) ? this.colour("--motion") : this.colour("--object-line");
  }

  // A colour of the page, looked up once as long as it is light, or dark.
  colour(name) {
    const dark = this.dark.matches;
    if (this.palette?.dark !== dark) this.palette = { dark };
    return (this.palette[name] ??= getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  }

  light() {
    const { graph } = this;
    this.far.hidden = this.chosen === null;
    this.cut.hidden = this.chosen !== null || this.mode !== "cuts";
    if (this.chosen !== null) {
      this.lit = graph.around(this.chosen, this.depth);
      this.said.textContent = `${this.depth} · ${counted(this.lit.size, "node")}`;
    } else if (this.mode === "tree") {
      const here = new Map(graph.units.map((unit, u) => [unit.id, u]));
      const mine = data.answer.units.map((unit) => here.get(unit.id)).filter((u) => u !== undefined);
      this.lit = new Set([...mine, ...mine.flatMap((u) => graph.near[u])]);
      this.said.textContent = counted(this.lit.size, "node");
    } else if (this.mode === "cuts") {
      const at = Number(this.cutRange.value);
      const cut = this.cuts[at - 1];
      const units = new Map(graph.units.map((unit, u) => [unit.id, u]));
      const objects = new Map(graph.objects.map((node, o) => [node.id, graph.units.length + o]));
      this.lit = new Set([...cut.members.map((id) => units.get(id)), ...cut.nodes.map((id) => objects.get(id))]);
      const sum = this.cuts.slice(0, at).reduce((total, each) => total + each.weight, 0);
      this.said.textContent = `${at} of ${this.cuts.length}, weight ${+cut.weight.toPrecision(4)}: ${+sum.toPrecision(4)} of ${+data.proof.cost.toPrecision(4)}`;
    } else {
      this.lit = this.only === undefined ? null : new Set(graph.groups[this.only].units.flatMap((u) => [u, ...graph.near[u]]));
      this.said.textContent = "";
    }
    this.paint();
  }

  legend() {
    const { graph } = this;
    const swatch = (fill, text) => {
      const mark = el("i", {});
      mark.style.background = fill;
      return el("span", {}, mark, text);
    };
    let shown;
    if (this.mode === "recipes") {
      shown = el("ul", {}, graph.groups.slice(0, 30).map((group, place) => el("li", {}, el("button", { class: "item", type: "button", "aria-pressed": String(this.only === place), click: () => {
        this.only = this.only === place ? undefined : place;
        this.choose(null);
        this.legend();
      } }, el("span", { class: "legend" }, swatch(hue(place), `${group.name} `), el("small", { class: "said" }, counted(group.units.length, "unit")))))));
    } else {
      this.only = undefined;
      const words = this.mode === "reach"
        ? [["--goal", "in the kitchen"], ["--object-line", "can be made"], ["--motion", "unit that can be done"], ["--rule", "out of reach"]]
        : this.mode === "cuts" ? [["--motion", "unit that crosses the cut: every tree has one of these"], ["--object-line", "object in the cut"]]
        : [["--motion", "unit"], ["--object-line", "object node"]];
      shown = el("div", { class: "legend" }, words.map(([name, text]) => swatch(this.colour(name), text)));
    }
    const title = this.mode === "recipes" ? (graph.named ? "Recipes" : "Parts that hang together") : "Colours";
    const note = this.mode === "recipes" && !graph.named ? el("p", { class: "said" }, "The data name one source alone, so units that share what few others use are coloured alike, and named by what most of them make.") : null;
    this.key.replaceChildren(el("h2", {}, title), ...[note].filter(Boolean), shown);
  }

  find() {
    const { graph } = this;
    const whole = this.search.value.trim().toLowerCase();
    const words = whole.split(/\s+/).filter(Boolean);
    const found = [];
    if (words.length)
      for (let i = graph.count - 1; i >= 0 && found.length < 400; i--) {
        const text = (graph.isUnit(i) ? `${graph.units[i].motion} unit ${graph.units[i].id}` : graph.object(i).node).toLowerCase();
        if (words.every((word) => text.includes(word))) found.push([graph.name(i).toLowerCase() === whole ? -1 : text.indexOf(words[0]), text.length, i]);
      }
    found.sort((a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2]);
    this.results.replaceChildren(...found.slice(0, 30).map(([, , i]) => el("li", {}, this.link(i, true))),
      ...(words.length && !found.length ? [el("li", { class: "said" }, "Nothing has this name.")] : []),
      ...(found.length > 30 ? [el("li", { class: "said" }, `${found.length - 30} more${found.length >= 400 ? " and others" : ""}`)] : []));
  }

  link(i, go = false) {
    const { graph } = this;
    return el("button", { class: "item", type: "button", title: graph.isUnit(i) ? "" : graph.object(i).node, click: () => this.choose(i, go || !this.inSight(i)) },
      graph.isUnit(i) ? [`${graph.units[i].motion} `, el("span", { class: "said" }, `unit ${graph.units[i].id}`)] : brief(graph.object(i)));
  }

  inSight(i) {
    const { x, y, k } = this.view;
    const [left, top] = [this.graph.x[i] * k + x, this.graph.y[i] * k + y];
    return left > 20 && top > 20 && left < this.room.width - 20 && top < this.room.height - 20;
  }

  choose(i, go = false) {
    this.chosen = i;
    if (i !== null) this.only = undefined;
    if (go) {
      const k = Math.max(this.view.k, 0.9);
      this.view = { k, x: this.room.width / 2 - this.graph.x[i] * k, y: this.room.height / 2 - this.graph.y[i] * k };
    }
    this.tell();
    this.light();
  }

  tell() {
    const { graph, chosen } = this;
    this.details.hidden = chosen === null;
    if (chosen === null) return;
    const list = (name, nodes) => nodes.length ? [el("h3", {}, `${name}: ${nodes.length}`), el("ul", {}, nodes.slice(0, 40).map((i) => el("li", {}, this.link(i))))] : [];
    const close = el("button", { type: "button", class: "tool", click: () => this.choose(null) }, "Close");
    if (graph.isUnit(chosen)) {
      const unit = graph.units[chosen];
      this.details.replaceChildren(el("h2", {}, `Unit ${unit.id}: ${unit.motion}`), el("ul", {}, sourceList(unit)),
        ...list("takes", unit.inputs.map((o) => graph.units.length + o)), ...list("gives", unit.outputs.map((o) => graph.units.length + o)), close);
      return;
    }
    const o = chosen - graph.units.length;
    const makers = [...graph.units.keys()].filter((u) => graph.units[u].outputs.includes(o));
    const takers = [...graph.units.keys()].filter((u) => graph.units[u].inputs.includes(o));
    const state = graph.kitchen.has(o) ? "in the kitchen" : graph.reachable.has(o) ? "can be made" : "out of reach";
    this.details.replaceChildren(el("h2", {}, graph.object(chosen).node), el("p", { class: "said" }, state), ...list("made by", makers), ...list("needed by", takers), close);
  }

  click(_, x, y) {
    const { graph, view } = this;
    let best = null;
    let least = 14 ** 2;
    for (let i = 0; i < graph.count; i++) {
      const far = (graph.x[i] * view.k + view.x - x) ** 2 + (graph.y[i] * view.k + view.y - y) ** 2;
      if (far < least) [least, best] = [far, i];
    }
    this.choose(best);
  }
}

TABS.push(["The network", () => Boolean(data.network), (panel) => new NetworkPanel(panel)]);
