/* The panes as elements. Text of streams, shaders and listings is only ever set as textContent. */

/* The contents of a column: lines that can be pointed at, each with its kin, and `via`: the kin of the calls in
 * a line. */
class View {
  constructor(pane) {
    this.pane = pane;
    this.lines = [];
    this.byKin = new Map();
    this.byVia = new Map();
    this.byNumber = new Map(); /* of the program: the line that defines it */
    this.element = document.createElement("div");
    this.controls = [];
    this.note = "";
  }

  add(element, kin, via = []) {
    const line = { element, kin, via, view: this, index: this.lines.length };
    element.lineNumber = line.index;
    for (const id of kin) addTo(this.byKin, id, line);
    for (const id of via) addTo(this.byVia, id, line);
    this.lines.push(line);
    return line;
  }
}

function make(name, className, text) {
  const element = document.createElement(name);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
}

/* --- Colours of text --- */

const KEYWORDS = "static|inline|const|struct|enum|int|unsigned|void|float|return|if|else|for|while|" +
  "switch|case|default|break|continue|u?int\\d+_t|flt|itg|fix|msk";
const C_TOKEN = new RegExp([/(\/\*.*?(?:\*\/|$)|\/\/.*$|"(?:[^"\\]|\\.)*")/.source,
  `\\b(${KEYWORDS})\\b`, /\b(0x[0-9a-fA-F]+|\d[\d.]*f?)\b/.source].join("|"), "g");
const IR_TOKEN = /(;.*$)|\b(flt|itg|fix|msk)\b|(%\d+)|\b(0x[0-9a-fA-F]+|-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)\b/g;
const IR_CLASS = ["c", "k", "o", "l"], C_CLASS = ["c", "k", "l"];

/* Appends the text to the element, with a span for each token; the groups of the pattern have the classes. */
function colour(element, text, pattern, classes) {
  let at = 0;
  for (const found of text.matchAll(pattern)) {
    if (found.index > at) element.append(text.slice(at, found.index));
    const group = found.slice(1).findIndex((part) => part !== undefined);
    const span = make("span", classes[group], found[0]);
    if (classes[group] === "o") span.dataset.number = found[0].slice(1);
    element.append(span);
    at = found.index + found[0].length;
  }
  element.append(text.slice(at));
}

/* A line of C; returns true if a comment is still open after it. */
function colourC(element, text, open) {
  if (open) {
    const end = text.indexOf("*/");
    element.append(make("span", "c", end < 0 ? text : text.slice(0, end + 2)));
    if (end < 0) return true;
    text = text.slice(end + 2);
  }
  colour(element, text, C_TOKEN, C_CLASS);
  const begin = text.lastIndexOf("/*");
  return begin >= 0 && text.indexOf("*/", begin) < 0;
}

function lineOf(className, number) {
  const line = make("div", "line " + className);
  line.append(make("span", "n", number));
  return line;
}

function toggle(label, pressed, change) {
  const button = make("button", "", label);
  button.type = "button";
  const set = (on) => { button.setAttribute("aria-pressed", on); change(on); };
  button.onclick = () => set(button.getAttribute("aria-pressed") !== "true");
  set(pressed);
  return button;
}

/* --- The sources --- */

function table(view, heads) {
  const element = make("table"), row = element.createTHead().insertRow();
  for (const [name, className] of heads) {
    const cell = make("th", className, name);
    cell.scope = "col";
    row.append(cell);
  }
  view.element.append(element);
  return element.createTBody();
}

function cell(row, className, text) {
  row.append(make("td", className, text));
}

function keyView(pane) {
  const view = new View(pane), body = table(view, [["field"], ["value"], ["operations", "r"], ["meaning"]]);
  for (const [field, value, meaning, caused] of pane.lines) {
    const row = body.insertRow(), kin = rangeList(caused);
    cell(row, "m", field);
    cell(row, "", value);
    cell(row, "r", kin.length || "");
    cell(row, "words", meaning);
    view.add(row, kin);
  }
  return view;
}

function shaderView() {
  const view = new View({ id: "shader" });
  view.note = `${model.shader.name}, ${model.shader.slots} instruction slots. ` +
    "Beside a line: the operations that it recorded.";
  model.shader.lines.forEach((text, at) => {
    const kin = recordedByShader.get(at + 1) || [], line = lineOf(kin.length ? "" : "unused", at + 1);
    const span = make("span", "t");
    colour(span, text, /(;.*$|\/\/.*$)|^\s*(\S+)|(-?\b\d+\.\d+\b)/g, ["c", "m", "l"]);
    line.append(make("span", "q", kin.length || ""), span);
    view.element.append(line);
    view.add(line, kin);
  });
  return view;
}

/* The lines of a file in blocks, which end with a brace or a # in the first column: functions with their
 * comments. Neighbours that record nothing are one block. */
function blocksOf(path, texts) {
  const blocks = [];
  let block = { first: 0, count: 0, used: false };
  const end = () => {
    const last = blocks[blocks.length - 1];
    if (last && !last.used && !block.used) last.count += block.count;
    else if (block.count) blocks.push(block);
    block = { first: block.first + block.count, count: 0, used: false };
  };
  texts.forEach((text, at) => {
    const key = path + ":" + (at + 1);
    block.count++;
    block.used ||= recordedAt.has(key) || recordedVia.has(key);
    if (text[0] === "}" || text[0] === "#") end();
  });
  end();
  return blocks;
}

function specLine(view, parent, path, at, text, open) {
  const key = path + ":" + (at + 1);
  const kin = recordedAt.get(key) || [], via = recordedVia.get(key) || [];
  const count = kin.length + via.length, line = lineOf(count ? "" : "unused", at + 1);
  const span = make("span", "t");
  const still = colourC(span, text, open);
  line.append(make("span", "q", count || ""), span);
  parent.append(line);
  view.add(line, kin, via);
  return still;
}

function gapOf(block, hidden) {
  const gap = make("button", "gap", `\u22ef ${block.count} lines that record nothing`);
  gap.type = "button";
  gap.onclick = () => { hidden.hidden = !hidden.hidden; };
  return gap;
}

function specView() {
  const view = new View({ id: "spec" });
  view.note = "The functions that recorded the routine. Beside a line: the operations that it recorded, " +
    "itself or in calls.";
  for (const file of model.files) {
    const section = make("section"), texts = file.text.split("\n");
    section.append(make("div", "file", "src/" + file.path));
    let open = false;
    for (const block of blocksOf(file.path, texts)) {
      const parent = make("div");
      if (!block.used) {
        parent.hidden = true;
        section.append(gapOf(block, parent));
      }
      section.append(parent);
      for (let at = block.first; at < block.first + block.count; at++)
        open = specLine(view, parent, file.path, at, texts[at], open);
    }
    view.element.append(section);
  }
  return view;
}

/* --- Programs --- */

function programLine(view, line) {
  const element = lineOf(MARK_CLASS[line.mark], line.number), text = make("span", "t");
  colour(text, line.text, IR_TOKEN, IR_CLASS);
  element.append(text);
  if (line.old && line.old !== line.text) element.append(make("del", "", line.old.trim()));
  if (line.by) element.append(make("span", "by", "\u2192 %" + line.by));
  element.append(make("span", "p", shortPlace(line.origin)));
  view.element.append(element);
  view.add(element, kinList(line.origin));
  if (line.mark !== MARK.removed) view.byNumber.set(line.number, element);
}

function programView(pane) {
  const view = new View(pane), count = [0, 0, 0, 0];
  view.element.className = "ir";
  for (const line of pane.program) {
    programLine(view, line);
    count[line.mark]++;
  }
  const changed = count[MARK.added] + count[MARK.altered] + count[MARK.removed];
  view.note = `${pane.note} ${pane.program.length - count[MARK.removed]} operations`;
  view.note += changed ? `: ${count[3]} removed, ${count[1]} added, ${count[2]} altered.` : ".";
  if (changed)
    view.controls.push(toggle("only changes", false, (on) => view.element.classList.toggle("changes", on)));
  return view;
}

function runsView(pane) {
  const view = new View(pane);
  const body = table(view, [["round", "r"], ["pass"], ["removed", "r"], ["added", "r"], ["altered", "r"],
    ["left", "r"], ["meaning"]]);
  pane.lines.forEach(([round, pass, changed, removed, added, altered, left, meaning], at) => {
    const row = body.insertRow();
    cell(row, "r", round || "once");
    cell(row, "m", pass);
    for (const number of [removed, added, altered]) cell(row, "r", changed ? number : "");
    cell(row, "r", left);
    cell(row, "words", changed ? meaning : "nothing changed");
    if (!changed) row.className = "idle";
    const line = view.add(row, []);
    if (changed) line.opens = `${pane.engine}/run-${at + 1}`;
  });
  view.note = pane.note + " Click on one for its result.";
  return view;
}

/* --- Listings --- */

function codeView(pane) {
  const view = new View(pane);
  view.element.className = "code";
  for (const [kin, offset, bytes, number, comment] of pane.lines) {
    const line = lineOf(offset < 0 ? "part" : "", offset < 0 ? "" : offset.toString(16));
    const text = make("span", "t");
    if (offset >= 0) line.append(make("span", "b", bytes));
    if (offset < 0) text.textContent = model.texts[number];
    else colour(text, model.texts[number], /^(\S+)|\b(0x[0-9a-f]+)\b/g, ["m", "l"]);
    line.title = offset < 0 ? comment : bytes.replace(/../g, "$& ");
    line.append(text, make("span", "p", comment));
    view.element.append(line);
    view.add(line, kinList(kin));
  }
  view.note = pane.note;
  return view;
}

function textView(pane) {
  const view = new View(pane);
  let open = false;
  pane.lines.forEach(([kin, number], at) => {
    const line = lineOf("", at + 1), text = make("span", "t");
    open = colourC(text, model.texts[number], open);
    line.append(text);
    view.element.append(line);
    view.add(line, kinList(kin));
  });
  view.note = pane.note;
  return view;
}

const VIEWS = { key: keyView, ir: programView, runs: runsView, code: codeView, text: textView,
  intervals: (pane) => intervalsView(pane) };

function viewOf(id, column) {
  if (id === "spec") return specView();
  if (id === "shader") return shaderView();
  if (id === "graph") return graphView(column);
  const view = VIEWS[panes.get(id).kind](panes.get(id));
  view.note ||= panes.get(id).note;
  return view;
}
