// Why there is no tree: what is needed and cannot be had, from the goal back, the easiest way first.

const OPENED = 24;

class DeadEnds {
  constructor({ unreachable_goals, dead_ends, roots }) {
    this.steps = [];
    this.goals = unreachable_goals;
    this.makers = new Map(dead_ends.map(({ object, makers }) => [keyOf(object), makers]));
    this.roots = new Map(roots.map((root) => [keyOf(root.object), root]));
    for (const root of roots) for (const each of root.cycle ?? []) this.roots.set(keyOf(each.object), root);
  }

  graph() {
    const nodes = new Map();
    const arrows = [];
    const frontier = [...this.goals];
    const goals = new Set(this.goals.map(keyOf));
    const object = (node) => {
      const id = `o${keyOf(node)}`;
      if (!nodes.has(id)) {
        nodes.set(id, { ...pill(id, node, null, goals.has(keyOf(node))), near: false, lost: this.roots.has(keyOf(node)) });
        frontier.push(node);
      }
      return id;
    };
    this.goals.forEach(object);
    const opened = new Set();
    while (frontier.length && opened.size < OPENED) {
      const node = frontier.shift();
      if (opened.has(keyOf(node))) continue;
      opened.add(keyOf(node));
      const maker = this.makers.get(keyOf(node))?.[0];
      if (!maker) continue;
      const id = `u${maker.id}`;
      if (!nodes.has(id)) {
        const lacks = new Set(maker.lacks.map(keyOf));
        const rows = maker.inputs.filter((input) => !lacks.has(keyOf(input))).map((input) => row(input, "kitchen"));
        const height = 26 + rows.reduce((sum, each) => sum + each.h, 0) + (rows.length ? 8 : 0);
        nodes.set(id, { id, w: CARD, h: height, step: { ...maker, step: 0 }, rows });
        for (const lack of maker.lacks) arrows.push({ from: object(lack), to: id });
      }
      arrows.push({ from: id, to: object(node) });
    }
    return { nodes: [...nodes.values()], arrows: acyclic(arrows) };
  }
}

// Marks the arrows that close a cycle as leading back: into the unit that would have to begin.
function acyclic(arrows) {
  const next = new Map();
  const reaches = (from, to) => {
    const seen = new Set([from]);
    const left = [from];
    while (left.length) {
      const at = left.pop();
      if (at === to) return true;
      for (const other of next.get(at) ?? []) if (!seen.has(other)) { seen.add(other); left.push(other); }
    }
    return false;
  };
  const made = (arrow) => arrow.from.startsWith("u");
  return [...arrows.filter(made), ...arrows.filter((arrow) => !made(arrow))].map((arrow) => {
    if (reaches(arrow.to, arrow.from)) return { ...arrow, back: true };
    next.set(arrow.from, [...(next.get(arrow.from) ?? []), arrow.to]);
    return arrow;
  });
}

TABS.push(["Why there is no tree", () => Boolean(data.why_not), (panel) => {
  const { why_not: why, shopping_list: shopping } = data;
  const words = el("aside", { "aria-label": "The reasons in words", class: why.tree_exists ? "alone" : null });
  if (!why.tree_exists) {
    const stage = el("div", { class: "stage" });
    panel.append(stage);
    const picture = new Picture(stage, new DeadEnds(why), { label: "What is needed and cannot be had", picked: () => {} });
    picture.mark(new Map([...picture.boxes].filter(([, { node }]) => !node.step).map(([id, { node }]) => [id, [node.lost ? "lost" : "lacking"]])));
  }
  panel.append(words);
  if (why.clash) {
    const rules = (list) => el("ul", {}, (list ?? []).map((rule) => el("li", {}, el("code", {}, rule.text), el("div", { class: "said" }, [shortPlace(rule), ...rule.constants].join(" · ")))));
    words.append(el("h2", {}, "The rules are the reason"), el("p", {}, "Without them there is a tree. These cannot all hold:"), rules(why.clash.smallest_clash),
      el("h2", {}, "It is enough to drop"), rules(why.clash.cheapest_to_drop));
  }
  const easiest = why.roots.filter((root) => root.on_the_easiest_way);
  if (easiest.length) words.append(el("h2", {}, "In the way"));
  for (const root of easiest) {
    const section = el("section", {}, el("h3", {}, root.object.node));
    if (root.cycle) section.append(el("p", {}, "can only be made from itself, in a cycle:"), el("ol", {}, root.cycle.map((each) =>
      el("li", {}, ...brief(each.object), el("div", { class: "said" }, `is needed by ${each.needed_by.motion} (${each.needed_by.source.length ? shortPlace(each.needed_by.source[0]) : ""})`)))));
    else section.append(el("p", {}, "is not in the kitchen, and no unit makes it."), root.stops.length
      ? el("p", { class: "said" }, `It stops ${root.stops.map((unit) => unit.motion).slice(0, 4).join(", ")}.`) : null);
    for (const near of root.near) section.append(el("p", { class: "said" }, `A typing error? There is ${near.name}, which differs in its ${near.differs_in}.`));
    if (root.alike.length) section.append(el("p", { class: "said" }, `Most like it: ${root.alike.map((node) => node.node).join(" and ")}.`));
    words.append(section);
  }
  if (shopping?.lists.length) {
    words.append(el("h2", {}, "What to add to the kitchen"));
    for (const [place, list] of shopping.lists.entries())
      words.append(el("ul", {}, list.items.map((item) => el("li", { class: "plus" }, ...brief(item)))),
        el("p", { class: "said" }, list.proved ? `${place ? "But for those that hold all of one above, no" : "No"} list of things for sale is shorter or cheaper.` : "A shorter list may exist."));
    if (shopping.answer?.units) words.append(el("p", {}, `With the first list, there is a tree of ${counted(shopping.answer.costs.units, "unit")}: see Side by side.`));
  }
  if (!why.tree_exists) words.append(el("div", { class: "legend" }, el("span", {}, el("i", { class: "dead" }), "the root of it"), el("span", {}, el("i", { class: "lacking" }), "cannot be had"), el("span", {}, el("i", { class: "kitchen" }), "can be had")));
}]);
