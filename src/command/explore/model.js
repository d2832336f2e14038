"use strict";
/* The data of the page, and what is derived from it.
 *
 * model.engines   name, description
 * model.texts     the table of texts; lines have numbers in it
 * model.files     path and text of the files of the specification
 * model.places    [file, line, text of the function's name, place of the call]; place 0 is none
 * model.place     by recorded instruction: its place
 * model.shader    name, slots, lines; line: by recorded instruction, its line or 0; absent without a shader
 * model.kin       all numbers of kin are below this; recorded instructions are below model.place.length
 * model.panes     id, engine ("": of all engines), kind, title, note, lines
 *
 * Lines, by the kind of their pane:
 *   key        [field, value, meaning, [first, last, first, last ...]]: recorded instructions that it causes
 *   ir         [mark, number, text, origin, ...], or [first, count]: the same lines as those of the program
 *              before, whose removed lines do not count. The mark is one of MARK; an altered line also has
 *              its old text, a removed one the number of the instruction that replaces it, or 0. The program
 *              before is the result of the engine's last pane of this kind, else the recording.
 *   runs       [round, pass, changed, removed, added, altered, instructions left, meaning]
 *   intervals  [number, last use, last position in the register or -1, register, slot or -1, operation,
 *              origin, type]; also `positions` and `loops`
 *   code       [kin, offset or -1, bytes, text, comment]: kin is a number, 0: none; or own, a number, and
 *              line, a path and a line of the specification, whose operations are kin too
 *   text       [kin, text] */
const model = JSON.parse(document.getElementById("model").textContent);

const MARK = { same: 0, added: 1, altered: 2, removed: 3 };
const MARK_CLASS = ["same", "added", "altered", "removed"];
const MASK_REGISTERS = 32;

const panes = new Map(model.panes.map((pane) => [pane.id, pane]));

/* Expands the lines of the programs to objects. */
function expandPrograms() {
  const result = new Map();
  for (const pane of model.panes) {
    if (pane.kind !== "ir") continue;
    const before = result.get(pane.engine) || result.get("") || [];
    pane.program = [];
    for (const line of pane.lines) {
      if (line.length === 2) {
        for (const kept of before.slice(line[0], line[0] + line[1]))
          pane.program.push({ ...kept, mark: MARK.same, old: null });
        continue;
      }
      const [mark, number, text, origin, more] = line;
      pane.program.push({ mark, number, text: model.texts[text], origin,
        old: mark === MARK.altered ? model.texts[more] : null, by: mark === MARK.removed ? more : 0 });
    }
    result.set(pane.engine, pane.program.filter((line) => line.mark !== MARK.removed));
  }
}
expandPrograms();

const recording = new Map(panes.get("record").program.map((line) => [line.number, line]));

/* By "path:line" of the specification: the instructions that it records, and those recorded by functions that
 * it calls. */
const recordedAt = new Map(), recordedVia = new Map();

function addTo(map, key, value) {
  const list = map.get(key);
  if (!list) map.set(key, [value]);
  else if (list[list.length - 1] !== value) list.push(value);
}

/* The places of an instruction, from the innermost call outwards. */
function chainOf(origin) {
  const chain = [];
  for (let place = model.place[origin] || 0; place; place = model.places[place][3]) {
    const [file, line, name] = model.places[place];
    chain.push({ file, line, path: model.files[file].path, name: model.texts[name] });
  }
  return chain;
}

model.place.forEach((place, origin) => {
  if (!place) return;
  chainOf(origin).forEach((at, depth) =>
    addTo(depth ? recordedVia : recordedAt, at.path + ":" + at.line, origin));
});

const shaderLine = (origin) => (model.shader ? model.shader.line[origin] || 0 : 0);
const recordedByShader = new Map();
for (const [origin, line] of (model.shader ? model.shader.line : []).entries())
  if (line) addTo(recordedByShader, line, origin);

/* "color.h:67" */
function shortPlace(origin) {
  const chain = chainOf(origin);
  return chain.length ? chain[0].path.replace(/^.*\//, "") + ":" + chain[0].line : "";
}

function kinList(kin) {
  if (typeof kin === "object") return [...(recordedAt.get(kin.line) || []), kin.own];
  return kin ? [kin] : [];
}

function rangeList(ranges) {
  const list = [];
  for (let i = 0; i < ranges.length; i += 2) for (let n = ranges[i]; n <= ranges[i + 1]; n++) list.push(n);
  return list;
}

const registerName = (reg) => (reg < MASK_REGISTERS ? "v" + reg : "k" + (reg - MASK_REGISTERS));

const title = `${model.stream}, frame ${model.frame}, draw ${model.draw}: ${model.unit} routine`;

/* The panes that can be chosen, with those that are made from the sources. */
const choices = [
  { id: "key", group: "Sources", title: "Key" },
  { id: "spec", group: "Sources", title: "Specification" },
  ...(model.shader ? [{ id: "shader", group: "Sources", title: "Shader" }] : []),
  { id: "record", group: "Sources", title: "Recording" },
  ...model.panes.filter((pane) => pane.engine)
    .map((pane) => ({ id: pane.id, group: pane.engine, engine: pane.engine, title: pane.title })),
  { id: "graph", group: "Pictures", title: "Graph" },
];
