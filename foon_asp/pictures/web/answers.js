// Answers beside each other: the tree asked for, and one of the others, with the units that differ coloured.

// The units of a list that another one does not have, each as often as it has it more often.
function beyond(units, others) {
  const left = new Map();
  for (const unit of others) left.set(unit.id, (left.get(unit.id) ?? 0) + 1);
  return units.filter((unit) => {
    const there = left.get(unit.id) ?? 0;
    left.set(unit.id, there - 1);
    return there <= 0;
  });
}

// Gives every list of steps in the data with what is known of it.
function others() {
  const found = [];
  const add = (name, steps, costs, goals, said = "", obstacle = null) => found.push({ name, steps, costs, goals, said, obstacle });
  const { answer } = data;
  if (data.lasting?.units) add("where nothing is used up", data.lasting.units, data.lasting.costs, answer.goals, claimOf(data.lasting)[0].toLowerCase());
  if (data.without_rules?.units) add("without the rules", data.without_rules.units, data.without_rules.costs, answer.goals, claimOf(data.without_rules)[0].toLowerCase());
  for (const search of data.searches) {
    const stop = search.as_listed;
    const said = search.units === null ? (search.stuck_at ? `no tree: stuck at ${search.stuck_at.node}` : "no tree") : search.verdict;
    add(search.search, search.units, search.costs, search.goals, said, stop);
  }
  data.alternatives?.trees.forEach((tree, place) => place && add(`${plans() ? "plan" : "tree"} ${place + 1}`, tree.units, tree.costs, answer.goals, `another ${plans() ? "plan" : "tree"}, the next best`));
  data.front?.points.forEach((point, place) => add(`point ${place + 1} of the front`, point.units, point.costs, answer.goals,
    Object.entries(point.measures).map(([name, value]) => `${name} ${figure(value)}`).join(" · ")));
  const list = data.shopping_list?.answer;
  if (list?.units) add("after buying", list.units, list.costs, list.goals, claimOf(list)[0].toLowerCase());
  return found;
}

class Answers {
  constructor(panel) {
    this.base = data.answer;
    this.others = others();
    this.asked = `the ${plans() ? "plan" : "tree"} asked for`;
    const rows = [{ name: this.base.units ? this.asked : "asked for", costs: this.base.costs, said: claimOf(this.base)[0].toLowerCase() }, ...this.others];
    this.panes = el("div", { class: "panes" });
    this.words = el("aside", { "aria-label": "The answers in words" });
    const body = el("tbody");
    this.rows = rows.map((each, place) => {
      const name = place && each.steps?.length ? el("button", { class: "item", type: "button", click: () => this.show(place - 1) }, each.name) : each.name;
      const row = el("tr", {}, el("td", {}, name, el("div", { class: each.said.includes("not execute") || each.said.startsWith("no ") ? "said bad" : "said" }, each.said)),
        el("td", { class: "figure" }, each.costs ? String(each.costs.units) : "–"), el("td", { class: "figure" }, each.costs ? figure(each.costs.success) : "–"));
      body.append(row);
      return row;
    });
    this.parts = el("section", { "aria-live": "polite" });
    this.words.append(el("h2", {}, "Answers"), el("table", {}, el("thead", {}, el("tr", {}, el("th", {}, "tree"), el("th", { class: "figure" }, "units"), el("th", { class: "figure" }, "success"))), body),
      this.parts, el("div", { class: "legend" }, el("span", {}, el("i", { class: "differs" }), "only in this one"), el("span", {}, el("i", { class: "dead" }), "cannot be done here")));
    panel.append(el("div", { class: "stage" }, this.panes), this.words);
    const first = this.others.findIndex((each) => each.steps?.length && this.differs(each));
    this.show(first >= 0 ? first : this.others.findIndex((each) => each.steps?.length));
  }

  differs(other) {
    const ours = this.base.units ?? [];
    return beyond(ours, other.steps).length + beyond(other.steps, ours).length > 0;
  }

  show(place) {
    const other = this.others[place];
    this.rows.forEach((row, number) => row.setAttribute("aria-selected", String(number === place + 1)));
    const ours = this.base.units ?? [];
    const [onlyOurs, onlyTheirs] = [beyond(ours, other.steps), beyond(other.steps, ours)];
    this.panes.replaceChildren();
    const shown = [];
    if (ours.length) shown.push(this.pane(this.asked, costsText(this.base.costs), ours, this.base.goals, onlyOurs));
    shown.push(this.pane(other.name, [costsText(other.costs), other.said].filter(Boolean).join(" · "), other.steps, other.goals, ours.length ? onlyTheirs : [], other.obstacle));
    this.pictures = shown;
    const list = (units, look) => el("ul", {}, units.map((unit) => el("li", { class: look, title: unit.source.map(shortPlace).join(", ") }, `${unit.step}. ${unit.motion} `, el("span", { class: "said" }, unit.source.length ? shortPlace(unit.source[0]) : ""))));
    const { obstacle } = other;
    this.parts.replaceChildren(...[
      obstacle ? [el("h3", {}, "first obstacle"), el("p", { class: "bad" }, obstacle.position
        ? `step ${obstacle.position}, ${obstacle.unit.motion}, lacks ${obstacle.missing.node}` : `all steps run, but ${obstacle.missing.node} is missing`)] : [],
      ours.length ? [el("h3", {}, `only in ${this.asked}: ${counted(onlyOurs.length, "unit")}`), list(onlyOurs, "minus"),
        el("h3", {}, `only in ${other.name}: ${counted(onlyTheirs.length, "unit")}`), list(onlyTheirs, "plus")] : [],
    ].flat());
  }

  pane(name, said, steps, goals, differing, obstacle = null) {
    const pane = el("section", { class: "pane" }, el("h2", {}, name), el("p", {}, said));
    this.panes.append(pane);
    const classes = new Map(differing.map((unit) => [`u${unit.step}`, ["differs"]]));
    if (obstacle?.position) classes.set(`u${obstacle.position}`, [...(classes.get(`u${obstacle.position}`) ?? []), "stuck"]);
    return new Picture(pane, new Plan(steps, goals), { label: `${name}: ${said}`, picked: () => {}, leftovers: false, marks: classes });
  }
}

TABS.push(["Side by side", () => Boolean(data.answer && others().some((each) => each.steps?.length)), (panel) => new Answers(panel)]);
