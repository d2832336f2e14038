/* The columns of the page, the marks of kin, and the keyboard. */

const byId = (id) => document.getElementById(id);
const COLUMNS_MAXIMUM = 6, TICKS_MAXIMUM = 400;
const HINT = "Point at a line, or move to it with the arrow keys: its kin in all columns are marked.\n" +
  "? lists the keys.";

/* The line whose kin are marked, and whether it stays when the pointer moves. */
let focused = null, pinned = false;
const columns = [];

/* --- Marks --- */

function clearMarks() {
  for (const element of document.querySelectorAll(".kin, .via, .cursor"))
    element.classList.remove("kin", "via", "cursor");
  for (const column of columns) { column.ruler.replaceChildren(); column.count.textContent = ""; }
}

/* The numbers that a line relates to: its own kin, and for a calling line those of the functions it calls. */
const numbersOf = (line) => (line.via.length ? [...line.kin, ...line.via] : line.kin);

function markColumn(column, numbers) {
  const kin = new Set(), via = new Set();
  for (const number of numbers) {
    for (const line of column.view.byKin.get(number) || []) kin.add(line);
    for (const line of column.view.byVia.get(number) || []) via.add(line);
  }
  for (const line of via) if (!kin.has(line)) line.element.classList.add("via");
  for (const line of kin) line.element.classList.add("kin");
  column.kin = [...kin].sort((a, b) => a.index - b.index);
  column.count.textContent = kin.size ? `${kin.size} kin` : "";
  column.drawRuler();
}

function mark(line) {
  clearMarks();
  focused = line;
  if (!line) { byId("status").textContent = HINT; return; }
  for (const column of columns) markColumn(column, numbersOf(line));
  line.element.classList.add("cursor");
  byId("status").textContent = describe(line);
}

/* One instruction with where it comes from, or how many there are. */
function describe(line) {
  const numbers = numbersOf(line).filter((number) => recording.has(number));
  if (!numbers.length) return "This line comes from no recorded operation.";
  const origin = numbers[0], first = recording.get(origin), shader = shaderLine(origin);
  const calls = chainOf(origin).map((at) => `${at.name} (${at.path.replace(/^spec\//, "")}:${at.line})`);
  const what = numbers.length > 1 ? `${numbers.length} recorded operations, the first: ` : "recorded as ";
  const parts = [`${what}%${origin} ${first.text.trim().replace(/\s+/g, " ")}`];
  if (shader) parts[0] += `, shader line ${shader}: ${model.shader.lines[shader - 1].trim()}`;
  return parts.concat("by " + calls.join(" \u2190 ")).join("\n");
}

function pin(line) {
  const again = pinned && focused === line;
  pinned = !again;
  mark(line);
  document.body.classList.toggle("pinned", pinned);
  if (pinned) for (const column of columns) if (column !== columnOf(line)) column.scrollTo(column.kin[0]);
  remember();
}

function unpin() {
  pinned = false;
  mark(null);
  remember();
}

/* --- Columns --- */

const columnOf = (line) => columns.find((column) => column.view === line.view);

class Column {
  constructor(id) {
    this.element = make("section", "column");
    this.bar = make("div", "bar");
    this.select = this.makeSelect();
    this.controls = make("span", "controls");
    this.count = make("span", "count");
    this.note = make("div", "note");
    this.body = make("div", "body");
    this.ruler = make("div", "ruler");
    this.body.tabIndex = 0;
    this.kin = [];
    this.bar.append(this.select, this.controls, this.count);
    this.element.append(this.bar, this.note, this.body, this.ruler);
    this.listen();
    this.show(id);
  }

  makeSelect() {
    const select = make("select");
    select.setAttribute("aria-label", "Contents of the column");
    for (const group of new Set(choices.map((choice) => choice.group))) {
      const element = make("optgroup");
      element.label = group;
      for (const choice of choices.filter((other) => other.group === group)) {
        const option = make("option", "", choice.engine ? `${choice.engine}: ${choice.title}` : choice.title);
        option.value = choice.id;
        element.append(option);
      }
      select.append(element);
    }
    select.onchange = () => { this.show(select.value); remember(); };
    return select;
  }

  listen() {
    this.body.addEventListener("pointerover", (event) => {
      const line = this.lineAt(event.target);
      this.showDefinition(event.target);
      if (!pinned && line && line !== focused) mark(line);
    });
    this.body.addEventListener("click", (event) => {
      const line = this.lineAt(event.target);
      if (line) this.choose(line);
    });
    this.body.addEventListener("focus", () => { active = columns.indexOf(this); });
  }

  lineAt(target) {
    const element = target.closest(".line, tr, .span, .node");
    return element && element.lineNumber !== undefined ? this.view.lines[element.lineNumber] : null;
  }

  /* Marks the definition of the operand that is pointed at. */
  showDefinition(target) {
    for (const element of this.body.querySelectorAll(".def")) element.classList.remove("def");
    const definition = target.dataset.number && this.view.byNumber.get(Number(target.dataset.number));
    if (definition) definition.classList.add("def");
  }

  choose(line) {
    if (line.opens) {
      const next = columns[columns.indexOf(this) + 1] || this;
      next.show(line.opens);
      remember();
    } else if (line.node !== undefined && line.node !== this.graph.center) {
      this.graph.center = line.node;
      this.show("graph");
      pinned = false;
      pin(this.view.lines.find((other) => other.node === this.graph.center));
    } else pin(line);
  }

  show(id) {
    const numbers = focused ? numbersOf(focused) : [], own = focused && focused.view === this.view;
    if (!choices.some((choice) => choice.id === id)) id = "record";
    this.id = this.select.value = id;
    this.view = viewOf(id, this);
    this.body.replaceChildren(this.view.element);
    this.body.scrollTop = this.body.scrollLeft = 0;
    this.body.setAttribute("aria-label", choices.find((choice) => choice.id === id).title);
    this.controls.replaceChildren(...this.view.controls);
    this.note.textContent = this.view.note;
    if (this.view.center) this.view.center.scrollIntoView({ block: "center", inline: "center" });
    if (own) { focused = null; pinned = false; clearMarks(); }
    else if (focused && columns.includes(this)) {
      markColumn(this, numbers);
      if (pinned) this.scrollTo(this.kin[0]);
    }
  }

  scrollTo(line) {
    if (!line) return;
    const hidden = line.element.closest("[hidden]");
    if (hidden) hidden.hidden = false;
    line.element.scrollIntoView({ block: "center", inline: "nearest" });
  }

  /* Ticks beside the scroll bar, where the kin are. */
  drawRuler() {
    const height = this.body.clientHeight, whole = this.body.scrollHeight;
    this.ruler.replaceChildren();
    if (whole <= height || this.id === "graph") return;
    this.ruler.style.top = this.body.offsetTop + "px";
    this.ruler.style.height = height + "px";
    const top = this.body.getBoundingClientRect().top - this.body.scrollTop;
    for (const line of this.kin.slice(0, TICKS_MAXIMUM)) {
      const tick = make("i");
      tick.style.top = 100 * (line.element.getBoundingClientRect().top - top) / whole + "%";
      this.ruler.append(tick);
    }
  }
}

let active = 0;

function addColumn(id) {
  if (columns.length === COLUMNS_MAXIMUM) return;
  const column = new Column(id);
  columns.push(column);
  byId("columns").append(column.element);
}

function removeColumn() {
  if (columns.length === 1) return;
  const column = columns.pop();
  if (focused && focused.view === column.view) unpin();
  column.element.remove();
  active = Math.min(active, columns.length - 1);
}

function layout(ids) {
  while (columns.length > ids.length) removeColumn();
  ids.forEach((id, at) => { if (columns[at]) columns[at].show(id); else addColumn(id); });
  remember();
}

/* --- Layouts --- */

function presetsOf() {
  const list = [], sources = model.shader ? "shader" : "key";
  const of = (engine, kind) =>
    model.panes.filter((pane) => pane.engine === engine.name && pane.kind === kind);
  const listing = (engine) => (of(engine, "code")[0] || of(engine, "text")[0]).id;
  const [first, second] = model.engines;
  list.push(["Overview", [sources, "spec", listing(first)]]);
  list.push(["Key", ["key", "spec", "record"]]);
  const passes = of(first, "runs")[0], programs = of(first, "ir");
  if (passes) {
    list.push(["Passes", [passes.id, "record", programs[0].id]]);
    const last = programs[programs.length - 1].id;
    list.push(["Registers", [last, of(first, "intervals")[0].id, listing(first)]]);
  }
  list.push(["Graph", [programs.length ? programs[programs.length - 1].id : "record", "graph"]]);
  if (second) list.push(["Engines", [listing(first), "record", listing(second)]]);
  return list;
}

const presets = presetsOf();

function showPresets() {
  presets.forEach(([name, ids], at) => {
    const button = make("button", "", name);
    button.type = "button";
    button.title = `Layout ${at + 1}`;
    button.onclick = () => layout(ids);
    byId("presets").append(button);
  });
}

/* The address keeps the layout and the line, so that a link to the page shows them. */
function remember() {
  const parts = ["show=" + columns.map((column) => column.id).join(",")];
  const column = pinned && focused ? columns.indexOf(columnOf(focused)) : -1;
  if (column >= 0) parts.push(`line=${column}.${focused.index}`);
  try { history.replaceState(null, "", "#" + parts.join("&")); } catch (refused) { /* as in some viewers */ }
}

function recall() {
  const wanted = new URLSearchParams(location.hash.slice(1));
  const ids = (wanted.get("show") || "").split(",")
    .filter((id) => choices.some((choice) => choice.id === id));
  layout(ids.length ? ids.slice(0, COLUMNS_MAXIMUM) : presets[0][1].slice(0, innerWidth < 1100 ? 2 : 3));
  const [column, index] = (wanted.get("line") || "").split(".").map(Number);
  const line = columns[column] && columns[column].view.lines[index];
  if (line) { pin(line); columns[column].scrollTo(line); }
}

/* --- Finding --- */

let foundAt = -1;

function find(text) {
  for (const element of document.querySelectorAll(".found")) element.classList.remove("found");
  foundAt = -1;
  if (!text) return;
  const sought = text.toLowerCase();
  for (const { element } of columns.flatMap((column) => column.view.lines))
    if (element.textContent.toLowerCase().includes(sought)) element.classList.add("found");
}

function findNext(by) {
  const found = [...document.querySelectorAll(".found")];
  if (!found.length) return;
  foundAt = (foundAt + by + found.length) % found.length;
  const column = columns.find((other) => other.body.contains(found[foundAt]));
  const line = column.view.lines[found[foundAt].lineNumber];
  column.scrollTo(line);
  pinned = false;
  pin(line);
}

/* --- Keys --- */

function moveTo(column, line) {
  if (!line) return;
  const stays = pinned;
  mark(line);
  pinned = stays;
  line.element.scrollIntoView({ block: "nearest", inline: "nearest" });
  active = columns.indexOf(column);
}

function moveBy(by) {
  const column = columns[active];
  const visible = column.view.lines.filter((line) => line.element.getClientRects().length);
  const outside = by > 0 ? -1 : visible.length;
  const at = focused && focused.view === column.view ? visible.indexOf(focused) : outside;
  moveTo(column, visible[Math.max(0, Math.min(visible.length - 1, at + by))]);
}

function moveAside(by) {
  active = (active + by + columns.length) % columns.length;
  const column = columns[active], kin = focused ? column.kin[0] : null;
  column.body.focus({ preventScroll: true });
  if (kin) { moveTo(column, kin); column.scrollTo(kin); } else if (!focused) moveBy(1);
}

function moveToKin(by) {
  const column = columns[active], list = column.kin;
  if (!list.length) return;
  column.nextKin = ((column.nextKin ?? -1) + by + list.length) % list.length;
  column.scrollTo(list[column.nextKin]);
}

function changePane(by) {
  const column = columns[active], at = choices.findIndex((choice) => choice.id === column.id);
  column.show(choices[(at + by + choices.length) % choices.length].id);
  remember();
}

/* The graph of the program in the active column, or of the recording, around the line. */
function openGraph() {
  const column = columns[columns.length - 1], from = columns[active];
  const isProgram = from.view.pane.kind === "ir", line = focused;
  const origin = line && numbersOf(line)[0];
  column.graph = { program: isProgram ? from.id : "record", up: 5, down: 2,
    center: isProgram && line ? from.view.pane.program[line.index].number : origin || 0 };
  column.show("graph");
  remember();
}

const KEYS = {
  ArrowDown: () => moveBy(1), j: () => moveBy(1), ArrowUp: () => moveBy(-1), k: () => moveBy(-1),
  PageDown: () => moveBy(20), PageUp: () => moveBy(-20), Home: () => moveBy(-1e9), End: () => moveBy(1e9),
  ArrowLeft: () => moveAside(-1), h: () => moveAside(-1),
  ArrowRight: () => moveAside(1), l: () => moveAside(1),
  n: () => moveToKin(1), p: () => moveToKin(-1), "[": () => changePane(-1), "]": () => changePane(1),
  Enter: () => { if (focused) columnOf(focused).choose(focused); }, Escape: unpin, g: openGraph,
  "/": () => byId("find").focus(), "?": () => byId("help").showModal(),
  "+": () => { addColumn("record"); remember(); }, "-": () => { removeColumn(); remember(); },
};

function onKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || byId("help").open) return;
  if (event.target.closest("input, select")) {
    if (event.key === "Escape") event.target.blur();
    return;
  }
  if (event.target.closest("button") && (event.key === "Enter" || event.key === " ")) return;
  const preset = presets[Number(event.key) - 1], action = preset ? () => layout(preset[1]) : KEYS[event.key];
  if (!action) return;
  action();
  event.preventDefault();
}

/* --- Begin --- */

document.title = title;
byId("title").textContent = title;
byId("status").textContent = HINT;
showPresets();
byId("more").onclick = KEYS["+"];
byId("fewer").onclick = KEYS["-"];
byId("keys").onclick = KEYS["?"];
byId("find").addEventListener("input", (event) => find(event.target.value));
byId("find").addEventListener("keydown", (event) => {
  if (event.key === "Enter") findNext(event.shiftKey ? -1 : 1);
});
addEventListener("keydown", onKey);
addEventListener("resize", () => columns.forEach((column) => column.drawRuler()));
recall();
document.documentElement.dataset.ready = "true";
