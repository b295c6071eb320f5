// The proof: cuts that every tree has to cross, one after the other, and their weights growing to the cost.

class ProofPanel {
  constructor(panel) {
    const { proof, answer } = data;
    this.proof = proof;
    this.names = new Map(proof.objects.map((node) => [node.id, node]));
    this.motions = new Map(proof.units.map((unit) => [unit.id, unit]));
    this.steps = new Map((answer.units ?? []).map((unit) => [unit.id, unit.step]));
    this.hasTree = Boolean(answer.units?.length);
    this.by = proof.certificate.objective[0];
    this.logs = this.by === "success";
    const stage = el("div", { class: "stage" });
    this.words = el("aside", { "aria-label": "The proof in words" });
    const ends = data.why_not && !data.why_not.tree_exists;
    if (this.hasTree || ends) {
      const plan = this.hasTree ? new Plan(answer.units, answer.goals) : new DeadEnds(data.why_not);
      this.picture = new Picture(stage, plan, { label: "What the cut that is shown is about", picked: () => {}, leftovers: false });
      panel.append(stage);
    } else this.words.classList.add("alone");
    panel.append(this.words);
    this.slider = el("input", { type: "range", min: 1, step: 1, "aria-label": "Cut", input: () => this.go(Number(this.slider.value)) });
    this.said = el("output", {});
    const tool = (text, help, act) => el("button", { type: "button", "aria-label": help, title: help, click: act }, text);
    const bar = el("div", { class: "bar" }, tool("◀", "The cut before", () => this.go(this.at - 1)), tool("▶", "The next cut", () => this.go(this.at + 1)), this.slider, this.said);
    if (proof.cases.length > 1) bar.append(el("select", { "aria-label": "Case", change: (event) => this.open(Number(event.target.value)) },
      proof.cases.map((_, place) => el("option", { value: place }, `case ${place + 1} of ${proof.cases.length}`))));
    if (this.picture) stage.append(bar);
    else this.words.append(bar);
    bar.hidden = proof.cases.length === 1 && proof.cases[0].cuts.length < 2;
    this.intro = el("section", {}, el("h2", {}, !this.hasTree ? "Why there is no tree" : plans() ? "What no plan goes below" : "Why nothing is cheaper"), ...this.explained());
    this.sum = el("div", { class: "sum", role: "img" });
    this.total = el("p", { "aria-live": "polite" });
    this.cut = el("section", { "aria-live": "polite" });
    this.words.append(this.intro, this.sum, this.total, this.cut,
      el("div", { class: "legend" }, el("span", {}, el("i", { class: "cut" }), "the cut, and who crosses it")));
    this.open(0);
  }

  explained() {
    if (!this.hasTree)
      return [el("p", {}, "A set of objects holds the goal and nothing that the kitchen has, and no unit makes one of them without needing another one of them first. So nobody can begin.")];
    return [
      el("p", {}, "A cut is a set of objects with the goal in it and nothing that the kitchen has. Whoever wants the goal has to get into it from outside: with a unit that makes one of its objects and needs none. So every tree, not only this one, has one of these units."),
      el("p", {}, `Every cut has a weight, and no unit is charged more than it costs${this.logs ? " (here −log of its success rate, so that a product becomes a sum)" : ""}. So every tree costs at least the sum of all weights${plans() ? "." : ", and this tree costs no more than that."}`),
      plans() ? el("p", {}, "Here items are used up. A plan is a tree, too, for whoever forgets that things run out: so what holds for trees holds for plans.") : null,
    ];
  }

  worth(value) {
    return this.logs ? `${+value.toPrecision(4)} (success ${+Math.exp(-value).toPrecision(4)})` : String(+value.toPrecision(6));
  }

  open(place) {
    this.case = this.proof.cases[place];
    this.slider.max = Math.max(1, this.case.cuts.length);
    this.go(1);
  }

  // What the plan costs by the first objective, which may be more than a tree does; for a tree, what it costs.
  planned(cost) {
    const ours = plans() ? data.answer.costs?.[this.by] : null;
    const value = ours?.approx ?? ours;
    return value === null || value === undefined ? cost : Math.max(cost, this.logs ? -Math.log(value) : value);
  }

  conclusion(cost, whole) {
    if (!plans()) return ": no tree costs less than this one. That is the proof.";
    if (whole <= cost * (1 + 1e-9)) return ": no plan costs less than this one. That is the proof.";
    const rest = data.answer.status === "optimal" ? "That there is none between is proved, too, but not by cuts." : "Whether there is one between is not known.";
    return `: no plan costs less than that, and this one costs ${this.worth(whole)}. ${rest}`;
  }

  label(id) {
    const node = this.names.get(id);
    return node ? brief(node) : [`object ${id}`];
  }

  unit(id) {
    const step = this.steps.get(id);
    const unit = this.motions.get(id);
    if (!unit) return `step ${id} of a rule`;
    return `${unit.motion}${step ? `, step ${step} of this tree` : `, not in this tree (${unit.source.length ? shortPlace(unit.source[0]) : ""})`}`;
  }

  go(number) {
    const { cuts, given, dear, paid } = this.case;
    this.at = Math.min(cuts.length, Math.max(1, number));
    this.slider.value = this.at;
    this.said.textContent = cuts.length ? `cut ${this.at} of ${cuts.length}` : "no cut";
    this.slider.setAttribute("aria-valuetext", this.said.textContent);
    const shown = cuts.slice(0, this.at);
    const sum = shown.reduce((total, cut) => total + (cut.weight ?? 0), paid);
    const cost = this.proof.cost;
    const whole = this.planned(cost);
    this.sum.replaceChildren();
    if (cost) {
      const part = (share, look) => {
        const span = el("span", { class: look });
        span.style.flexGrow = String(Math.max(0, share));
        return span;
      };
      if (paid) this.sum.append(part(paid, ""));
      for (const cut of shown) this.sum.append(part(cut.weight, ""));
      this.sum.append(part(Math.max(0, whole - sum), "open"));
      const done = sum >= cost * (1 - 1e-9) && !dear.length;
      this.total.replaceChildren(el("strong", {}, `${this.worth(sum)} of ${this.worth(cost)}`), ` ${this.by}`,
        dear.length ? ": with what a unit of this case costs beyond its cuts, no tree costs less." : "",
        done ? (given.length ? ": in this case, no tree costs less." : this.conclusion(cost, whole)) : "");
      this.sum.setAttribute("aria-label", `${this.worth(sum)} of ${this.worth(cost)}`);
    } else this.sum.hidden = true;
    const cut = cuts[this.at - 1];
    const parts = [];
    if (given.length) parts.push(el("h3", {}, "this case: every tree that"), some(given, (each) => each.kind === "item"
      ? [each.taken ? "takes " : "does without ", ...this.label(each.id)] : `${each.taken ? "has" : "has not"} ${this.unit(each.id)}`));
    if (dear.length) parts.push(el("h3", {}, given.length ? "and has one of these" : "this case: every tree that has one of these"),
      some(dear, (each) => each.kind === "item" ? this.label(each.id) : this.unit(each.id)));
    if (this.case.ends === "broken") parts.push(el("p", {}, "Such a tree breaks a rule that was asked for."));
    if (cut) {
      parts.push(el("h2", {}, cut.weight === null ? "The cut that nobody crosses" : `Cut ${this.at}, weight ${this.worth(cut.weight)}`));
      parts.push(el("h3", {}, cut.weight === null ? "who can get in" : "one of these has to get in"), cut.members.length
        ? el("ul", {}, cut.members.map((id) => el("li", { class: this.steps.has(id) ? "plus" : "" }, this.unit(id)))) : el("p", {}, "nobody"));
      parts.push(el("h3", {}, `the cut: ${counted(cut.nodes.length, "object")}`), el("ul", {}, cut.nodes.map((id) => el("li", {}, this.label(id)))));
    }
    this.cut.replaceChildren(...parts);
    if (this.picture) this.mark(cut);
  }

  mark(cut) {
    const classes = new Map();
    const inside = new Set((cut?.nodes ?? []).map(String));
    const members = new Set(cut?.members ?? []);
    for (const [id, { node }] of this.picture.boxes) {
      if (node.step && members.has(node.step.id)) classes.set(id, ["crossing"]);
      else if (node.node && inside.has(keyOf(node.node))) classes.set(id, ["inside"]);
    }
    this.picture.mark(classes);
    const first = [...classes].find(([, look]) => look[0] === "crossing");
    if (first) this.picture.reveal(first[0]);
  }
}

// A list of the first few.
function some(all, words) {
  const shown = all.slice(0, 20).map((each) => el("li", {}, words(each)));
  if (all.length > 20) shown.push(el("li", {}, `and ${all.length - 20} more`));
  return el("ul", {}, shown);
}

TABS.push([data.answer?.units?.length ? "The proof" : "The proof that there is none", () => Boolean(data.proof), (panel) => new ProofPanel(panel)]);
