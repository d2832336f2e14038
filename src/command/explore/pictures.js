/* The pictures: live intervals by register, and the graph of a program. */

function svg(name, attributes, parent, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/* --- Live intervals ---
 *
 * A row for each register that is used, and one for each spill slot; a value whose register is taken away and
 * that has no slot is read again from where it was ("again"). Above them, the number of values in vector
 * registers. */

const ROW = 15, LEFT = 56, TOP = 64, CURVE = 44;

function intervalRows(lines) {
  const registers = [...new Set(lines.map((line) => line[3]))].sort((a, b) => a - b);
  const spilled = lines.filter((line) => line[2] >= 0);
  const slots = [...new Set(spilled.map((line) => line[4]))].sort((a, b) => a - b);
  return [...registers.map((reg) => ({ key: "r" + reg, name: registerName(reg) })),
    ...slots.map((slot) => ({ key: "s" + slot, name: slot < 0 ? "again" : "slot " + slot }))];
}

/* The number of values in vector registers at each position, as the points of a line. */
function pressure(pane, scale) {
  const change = new Int32Array(pane.positions + 2);
  for (const [number, last, split, reg] of pane.lines) {
    if (reg >= MASK_REGISTERS) continue;
    change[number]++;
    change[(split >= 0 ? Math.min(split, last) : last) + 1]--;
  }
  let live = 0, most = 0;
  const counts = [...change].map((by) => { live += by; most = Math.max(most, live); return live; });
  const yOf = (count) => TOP - 14 - count * CURVE / Math.max(most, 1);
  const points = counts.slice(0, pane.positions + 1)
    .map((count, at) => `${(LEFT + at * scale).toFixed(1)},${yOf(count).toFixed(1)}`);
  return { most, points: points.join(" ") };
}

function drawAxis(picture, pane, rows, scale, width, height) {
  const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000].find((n) => n * scale >= 40) || 10000;
  for (const [head, again] of pane.loops)
    svg("rect", { class: "loop", x: LEFT + head * scale, y: TOP, width: (again - head) * scale,
      height: height - TOP }, picture);
  for (let at = 0; at <= pane.positions; at += step) {
    const x = LEFT + at * scale;
    svg("line", { class: "grid", x1: x, x2: x, y1: TOP - 4, y2: height }, picture);
    svg("text", { class: "dim", x: x + 2, y: TOP - 3 }, picture, at);
  }
  rows.forEach((row, at) => svg("text", { class: "dim", x: 4, y: TOP + at * ROW + 11 }, picture, row.name));
  const curve = pressure(pane, scale);
  svg("polyline", { class: "live", points: curve.points }, picture);
  svg("text", { class: "dim", x: 4, y: 12 }, picture, `at most ${curve.most} values in vector registers`);
}

function drawInterval(picture, line, rowOf, scale) {
  const [number, last, split, reg, slot, name, , type] = line;
  const group = svg("g", { class: "span " + type }, picture), end = Math.max(last, number + 0.6);
  const until = split >= 0 ? Math.min(split + 0.5, end) : end;
  const bar = (key, from, to, className) => svg("rect", { class: className, x: LEFT + from * scale,
    y: TOP + rowOf.get(key) * ROW + 2, width: Math.max((to - from) * scale, 1.5), height: ROW - 4,
    rx: 2 }, group);
  bar("r" + reg, number, until, "");
  if (split >= 0) bar("s" + slot, until, end, "spilled");
  let text = `%${number} ${name} in ${registerName(reg)}, to ${last}`;
  if (split >= 0) text += slot < 0 ? `; read again after ${split}` : `; in slot ${slot} after ${split}`;
  svg("title", {}, group, text);
  return group;
}

function intervalsView(pane) {
  const view = new View(pane), rows = intervalRows(pane.lines);
  const rowOf = new Map(rows.map((row, at) => [row.key, at]));
  const scale = Math.min(8, Math.max(1.6, 1000 / pane.positions));
  const width = LEFT + pane.positions * scale + 20, height = TOP + rows.length * ROW + 4;
  const legend = make("div", "legend words");
  for (const [type, meaning] of [["flt", "float"], ["itg", "integer"], ["fix", "pair of 16 bits"],
    ["msk", "mask"], ["memory", "spilled"]]) {
    const item = make("span", "", meaning), box = make("i");
    box.style.background = `var(--${type})`;
    item.prepend(box);
    legend.append(item);
  }
  const picture = svg("svg", { width, height, role: "img", "aria-label": "Live intervals by register" });
  drawAxis(picture, pane, rows, scale, width, height);
  for (const line of pane.lines) view.add(drawInterval(picture, line, rowOf, scale), kinList(line[6]));
  view.element.append(legend, picture);
  view.note = pane.note;
  return view;
}

/* --- The graph ---
 *
 * The instructions around one of a program: its operands and their operands, and its uses. Each is in a layer
 * above all of its users; the order within a layer follows the neighbours in the layer before. */

const NODE_HEIGHT = 20, LAYER = 46, NODE_GAP = 14, NODES_MAXIMUM = 160;

const operandsOf = (line) => [...line.text.matchAll(/%(\d+)/g)].map((found) => Number(found[1]));

function programOf(id) {
  const program = new Map();
  for (const line of panes.get(id).program)
    if (line.mark !== MARK.removed) program.set(line.number, { line, uses: [], operands: operandsOf(line) });
  for (const [number, node] of program)
    for (const operand of node.operands) if (program.has(operand)) program.get(operand).uses.push(number);
  return program;
}

/* Grows by one level at a time, so that the nearest instructions are in if there are too many. */
function neighbourhood(program, center, up, down) {
  const found = new Set([center]);
  const grow = (edge, levels) => {
    let front = [center];
    for (let level = 0; level < levels; level++) {
      const next = [];
      for (const number of front)
        for (const other of program.get(number)[edge])
          if (program.has(other) && !found.has(other) && found.size < NODES_MAXIMUM) {
            found.add(other);
            next.push(other);
          }
      front = next;
    }
  };
  grow("operands", up);
  grow("uses", down);
  return [...found].sort((a, b) => a - b);
}

/* Operands precede their users, except of phis and at the ends of loops; those edges do not count. */
function layersOf(program, numbers) {
  const inside = new Set(numbers), layer = new Map(), layers = [];
  for (let i = numbers.length - 1; i >= 0; i--) {
    const users = program.get(numbers[i]).uses.filter((user) => inside.has(user) && layer.has(user));
    layer.set(numbers[i], users.length ? Math.max(...users.map((user) => layer.get(user))) + 1 : 0);
  }
  const deepest = Math.max(...layer.values());
  for (const number of numbers) (layers[deepest - layer.get(number)] ||= []).push(number);
  return layers;
}

/* The places nearest to the wishes at which no two nodes of the layer overlap: the mean of those that result
 * from the left and from the right. */
function spread(layer, wish, widthOf, x) {
  const left = new Map();
  let least = -Infinity, most = Infinity;
  for (const number of layer) {
    const half = widthOf(number) / 2;
    left.set(number, Math.max(wish.get(number), least + half));
    least = left.get(number) + half + NODE_GAP;
  }
  for (const number of [...layer].reverse()) {
    const half = widthOf(number) / 2, right = Math.min(wish.get(number), most - half);
    x.set(number, (left.get(number) + right) / 2);
    most = right - half - NODE_GAP;
  }
}

/* In turns from the users up and from the operands down, each node moves towards the mean of its neighbours. */
function placeNodes(program, layers, widthOf) {
  const x = new Map();
  for (const layer of layers) spread(layer, new Map(layer.map((number) => [number, 0])), widthOf, x);
  for (let sweep = 0; sweep < 8; sweep++) {
    const edge = sweep % 2 ? "operands" : "uses";
    for (const layer of sweep % 2 ? layers : [...layers].reverse()) {
      const wish = new Map(layer.map((number) => {
        const others = program.get(number)[edge].filter((other) => x.has(other)).map((other) => x.get(other));
        const sum = others.reduce((total, at) => total + at, 0);
        return [number, others.length ? sum / others.length : x.get(number)];
      }));
      layer.sort((a, b) => wish.get(a) - wish.get(b));
      spread(layer, wish, widthOf, x);
    }
  }
  const left = Math.min(...[...x].map(([number, at]) => at - widthOf(number) / 2));
  for (const [number, at] of x) x.set(number, at - left + 10);
  return x;
}

function drawEdges(picture, program, numbers, x, y) {
  for (const number of numbers)
    for (const operand of program.get(number).operands) {
      if (!y.has(operand)) continue;
      const x1 = x.get(operand), y1 = y.get(operand) + NODE_HEIGHT, x2 = x.get(number), y2 = y.get(number);
      const bend = Math.max(12, Math.abs(y2 - y1) / 2);
      svg("path", { class: "edge", "marker-end": "url(#arrow)",
        d: `M${x1} ${y1}C${x1} ${y1 + bend} ${x2} ${y2 - bend} ${x2} ${y2 - 3}` }, picture);
    }
}

/* The number, the operation and its immediates. */
function labelOf(number, text) {
  const short = text.trim().replace(/^(flt|itg|fix|msk)\s+/, "").replace(/\s*%\d+/g, "").replace(/\s+/g, " ");
  return `%${number} ${short.slice(0, 28)}`;
}

function drawNode(picture, line, type, x, y, width, label) {
  const node = svg("g", { class: `node ${type}`, transform: `translate(${x - width / 2},${y})` }, picture);
  svg("rect", { width, height: NODE_HEIGHT, rx: 4 }, node);
  svg("text", { x: 7, y: 14 }, node, label);
  svg("title", {}, node, `%${line.number} ${line.text.trim()}\n${shortPlace(line.origin)}`);
  return node;
}

function makePicture(width, height) {
  const picture = svg("svg", { width, height, role: "img", "aria-label": "Graph of the program" });
  const arrow = svg("marker", { id: "arrow", viewBox: "0 0 6 6", refX: 5, refY: 3, markerWidth: 6,
    markerHeight: 6, orient: "auto" }, svg("defs", {}, picture));
  svg("path", { d: "M0 0L6 3L0 6z", fill: "currentColor" }, arrow);
  return picture;
}

function drawGraph(view, program, center, up, down) {
  const numbers = neighbourhood(program, center, up, down), layers = layersOf(program, numbers);
  const y = new Map(), label = (number) => labelOf(number, program.get(number).line.text);
  const widthOf = (number) => label(number).length * 6.7 + 14;
  const x = placeNodes(program, layers, widthOf);
  layers.forEach((layer, at) => layer.forEach((number) => y.set(number, 10 + at * LAYER)));
  const width = Math.max(...numbers.map((number) => x.get(number) + widthOf(number) / 2)) + 10;
  const picture = makePicture(width, layers.length * LAYER + 10);
  drawEdges(picture, program, numbers, x, y);
  for (const number of numbers) {
    const line = program.get(number).line, type = line.text.slice(0, 3).trim();
    const node = drawNode(picture, line, type, x.get(number), y.get(number), widthOf(number), label(number));
    view.add(node, kinList(line.origin)).node = number;
    if (number === center) (view.center = node).classList.add("center");
  }
  view.element.append(picture);
  return numbers.length;
}

/* The last store or scatter: what the routine is for. */
function lastEffect(program) {
  const numbers = [...program.keys()].reverse();
  return numbers.find((number) => /\b(store|scatter)/.test(program.get(number).line.text)) || numbers[0];
}

function graphControls(view, column, state) {
  const select = make("select");
  select.title = "The program of the graph";
  for (const pane of model.panes.filter((other) => other.kind === "ir")) {
    const option = make("option", "", (pane.engine ? pane.engine + ": " : "") + pane.title);
    option.value = pane.id;
    select.append(option);
  }
  select.value = state.program;
  select.onchange = () => { state.program = select.value; state.center = 0; column.show("graph"); };
  const levels = (name, key) => [["\u2212", -1], ["+", 1]].map(([sign, by]) => {
    const button = make("button", "", name + sign);
    button.type = "button";
    button.title = by > 0 ? "One level more" : "One level less";
    button.onclick = () => { state[key] = Math.max(0, state[key] + by); column.show("graph"); };
    return button;
  });
  return [select, ...levels("operands ", "up"), ...levels("uses ", "down")];
}

/* The result of the first engine's passes, if it has any, else the recording. */
function lastProgram() {
  const ids = model.panes.filter((pane) => pane.kind === "ir" && pane.engine === model.engines[0].name);
  return ids.length ? ids[ids.length - 1].id : "record";
}

function graphView(column) {
  const view = new View({ id: "graph" });
  const state = column.graph ||= { program: lastProgram(), center: 0, up: 5, down: 2 };
  const program = programOf(state.program);
  if (!program.has(state.center)) state.center = lastEffect(program);
  if (program.size) {
    const shown = drawGraph(view, program, state.center, state.up, state.down);
    const limit = shown === NODES_MAXIMUM ? ", which is the most that are drawn" : "";
    view.note = `The instructions around %${state.center}: ${shown}${limit}. ` +
      "Click on another one to move there.";
  }
  view.controls = graphControls(view, column, state);
  return view;
}
