// Where the boxes of a layered graph go: layers from top to bottom, few crossings, short arrows.
// Nodes are {id, w, h, near}, arrows {from, to, back}; arrows that lead back are left out of the layers, and a
// node that is near stands right below where its arrow comes from.

const LAYER_GAP = 30;
const SIDE_GAP = 18;

// Gives for each node x and y of its middle, for each arrow its points, and the size of it all.
function layered(nodes, arrows) {
  const boxes = new Map(nodes.map((node) => [node.id, { ...node, above: [], below: [] }]));
  const forward = arrows.filter((arrow) => !arrow.back && arrow.from !== arrow.to);
  const layers = inLayers(boxes, forward);
  const routes = new Map();
  for (const arrow of forward) routes.set(arrow, route(boxes, layers, arrow));
  layers.forEach((layer) => layer.forEach((box, place) => (box.place = place)));
  order(layers);
  const width = spread(layers);
  let y = 0;
  for (const layer of layers) {
    const height = Math.max(0, ...layer.map((box) => box.h));
    for (const box of layer) box.y = y + height / 2;
    y += height + LAYER_GAP;
  }
  return {
    boxes,
    routes: arrows.map((arrow) => points(boxes, routes.get(arrow), arrow)),
    width,
    height: Math.max(0, y - LAYER_GAP),
  };
}

// As far down as what comes next allows: what is needed late is drawn late.
function inLayers(boxes, arrows) {
  const next = new Map([...boxes.keys()].map((id) => [id, []]));
  for (const arrow of arrows) next.get(arrow.from).push(arrow.to);
  const heights = new Map();
  const open = new Set();
  const height = (id) => {
    if (heights.has(id)) return heights.get(id);
    if (open.has(id)) return 0;
    open.add(id);
    const found = Math.max(0, ...next.get(id).map((other) => height(other) + 1));
    open.delete(id);
    heights.set(id, found);
    return found;
  };
  const deepest = Math.max(0, ...[...boxes.keys()].map(height));
  const layers = Array.from({ length: deepest + 1 }, () => []);
  for (const box of boxes.values()) box.layer = deepest - heights.get(box.id);
  for (const arrow of arrows)
    if (boxes.get(arrow.to).near) boxes.get(arrow.to).layer = boxes.get(arrow.from).layer + 1;
  for (const box of boxes.values()) layers[box.layer].push(box);
  return layers;
}

// Leads an arrow through a narrow box in every layer between its ends.
function route(boxes, layers, arrow) {
  const from = boxes.get(arrow.from);
  const to = boxes.get(arrow.to);
  const path = [from];
  for (let layer = from.layer + 1; layer < to.layer; layer++) {
    const bend = { w: 14, h: 0, above: [], below: [], bend: true, layer };
    layers[layer].push(bend);
    path.push(bend);
  }
  path.push(to);
  for (let i = 1; i < path.length; i++) {
    path[i - 1].below.push(path[i]);
    path[i].above.push(path[i - 1]);
  }
  return path;
}

// Sweeps down and up: each box goes to the middle of its neighbours; the order with the fewest crossings stays.
function order(layers) {
  const renumber = () => layers.forEach((layer) => layer.forEach((box, place) => (box.place = place)));
  const mean = (box, side) => box[side].reduce((sum, other) => sum + other.place, 0) / box[side].length;
  let best = layers.map((layer) => [...layer]);
  let fewest = crossings(layers);
  for (let sweep = 0; sweep < 16 && fewest; sweep++) {
    const side = sweep % 2 ? "above" : "below";
    const walked = sweep % 2 ? layers : [...layers].reverse();
    for (const layer of walked) {
      for (const box of layer) box.wish = box[side].length ? mean(box, side) : box.place;
      layer.sort((a, b) => a.wish - b.wish || a.place - b.place);
      layer.forEach((box, place) => (box.place = place));
    }
    const now = crossings(layers);
    if (now < fewest) {
      fewest = now;
      best = layers.map((layer) => [...layer]);
    }
  }
  layers.forEach((layer, number) => layer.splice(0, layer.length, ...best[number]));
  renumber();
}

function crossings(layers) {
  let count = 0;
  for (const layer of layers) {
    const ends = layer.flatMap((box) => box.below.map((other) => [box.place, other.place]));
    for (let i = 0; i < ends.length; i++)
      for (let j = 0; j < i; j++)
        if ((ends[i][0] - ends[j][0]) * (ends[i][1] - ends[j][1]) < 0) count++;
  }
  return count;
}

// Gives every box its x: as near to the middle of its neighbours as those beside it allow.
function spread(layers) {
  for (const layer of layers) settle(layer, () => 0);
  for (let sweep = 0; sweep < 24; sweep++) {
    const sides = sweep >= 20 ? ["above", "below"] : [sweep % 2 ? "above" : "below"];
    for (const layer of sweep % 2 ? layers : [...layers].reverse())
      settle(layer, (box) => {
        const near = sides.flatMap((side) => box[side]);
        return near.length ? near.reduce((sum, other) => sum + other.x, 0) / near.length : box.x;
      });
  }
  const all = layers.flat();
  const left = Math.min(0, ...all.map((box) => box.x - box.w / 2));
  for (const box of all) box.x -= left;
  return Math.max(0, ...all.map((box) => box.x + box.w / 2));
}

// Least squares with a gap between neighbours: boxes that would overlap move together, as one block.
function settle(layer, wish) {
  const blocks = [];
  let shift = 0;
  layer.forEach((box, place) => {
    if (place) shift += (layer[place - 1].w + box.w) / 2 + SIDE_GAP;
    box.shift = shift;
    blocks.push({ sum: wish(box) - shift, boxes: [box] });
    while (blocks.length > 1) {
      const last = blocks[blocks.length - 1];
      const before = blocks[blocks.length - 2];
      if (before.sum / before.boxes.length <= last.sum / last.boxes.length) break;
      blocks.pop();
      before.sum += last.sum;
      before.boxes.push(...last.boxes);
    }
  });
  for (const block of blocks)
    for (const box of block.boxes) box.x = block.sum / block.boxes.length + box.shift;
}

function points(boxes, path, arrow) {
  if (path === undefined) return [arrow.from, arrow.to].map((id) => [boxes.get(id).x + boxes.get(id).w / 2, boxes.get(id).y]);
  return path.map((box, place) => {
    const end = place === 0 ? box.h / 2 : place === path.length - 1 ? -box.h / 2 : 0;
    return [box.x, box.y + end];
  });
}
