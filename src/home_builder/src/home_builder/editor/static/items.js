"use strict";
// Items of the plan, the selection and the clipboard. The path of an item is "walls/0", "walls/0/openings/1",
// "furniture/2" or "start"; the plan has the form of plan.yaml, but for the start, which is {x, y, yaw}.

const LISTS = ["walls", "furniture", "rooms", "places", "zones"];
const SNAP = 0.05, TURN = Math.PI / 12;  // grid [m] and steps of directions [rad]

let plan;
let selection = [];  // paths
let clipboard = {};  // lists of items by the name of their list

const rounded = value => Math.round(value * 1e4) / 1e4;
const onGrid = value => rounded(Math.round(value / SNAP) * SNAP);
const cloned = value => JSON.parse(JSON.stringify(value));

function fromFile(entries) {
  const { start, start_yaw, ...others } = entries;
  return { ...others, start: { x: start[0], y: start[1], yaw: start_yaw } };
}

function forFile(drawn) {
  const { start, ...others } = drawn;
  return { ...others, start: [start.x, start.y], start_yaw: start.yaw };
}

function itemOf(path) {
  return path.split("/").reduce((part, key) => part && part[key], plan);
}

function single() {
  return selection.length === 1 ? selection[0] : null;
}

function allPaths() {
  return LISTS.flatMap(list => plan[list].map((_, index) => `${list}/${index}`));
}

function anchorOf(path) {  // a point that stands for an item
  const item = itemOf(path);
  if (path.includes("openings")) return alongWall(itemOf(path.split("/").slice(0, 2).join("/")), item.at);
  if (item.x !== undefined) return [item.x, item.y];
  const points = item.corners || [item.start, item.end];
  return [0, 1].map(k => points.reduce((sum, point) => sum + point[k], 0) / points.length);
}

function move(item, dx, dy, original) {
  const at = ([x, y]) => [rounded(x + dx), rounded(y + dy)];
  if (item.x !== undefined) Object.assign(item, { x: rounded(original.x + dx), y: rounded(original.y + dy) });
  else if (item.corners) item.corners = original.corners.map(at);
  else Object.assign(item, { start: at(original.start), end: at(original.end) });
}

function turnSelection(angle) {
  change(() => {
    for (const item of selection.map(itemOf)) if (item.yaw !== undefined) item.yaw = rounded(wrapped(item.yaw + angle));
  });
}

function wrapped(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

function removeSelection() {
  const gone = new Set(selection.filter(path => path !== "start").map(itemOf));
  selection = [];
  change(() => {
    for (const list of LISTS) plan[list] = plan[list].filter(item => !gone.has(item));
    for (const wall of plan.walls) if (wall.openings) wall.openings = wall.openings.filter(each => !gone.has(each));
  });
  draw();
  showFields();
}

function copySelection() {
  const copied = {};
  for (const path of selection.filter(path => /^[a-z]+\/\d+$/.test(path))) {
    const list = path.split("/")[0];
    copied[list] = [...(copied[list] || []), cloned(itemOf(path))];
  }
  if (Object.keys(copied).length) clipboard = copied;
}

function paste(items, middle) {  // with the middle of the items at a point
  change(() => {
    selection = [];
    for (const list of LISTS) for (const item of items[list] || []) add(list, cloned(item));
    const anchors = selection.map(anchorOf);
    if (!anchors.length) return;
    const [dx, dy] = [0, 1].map(k => onGrid(middle[k] - anchors.reduce((sum, at) => sum + at[k], 0) / anchors.length));
    for (const item of selection.map(itemOf)) move(item, dx, dy, cloned(item));
  });
}

function add(list, item) {
  if (item.name) item.name = freeName(item.name);
  plan[list].push(item);
  selection.push(`${list}/${plan[list].length - 1}`);
}

function duplicate() {
  const kept = clipboard;
  clipboard = {};
  copySelection();
  const anchors = selection.filter(path => /^[a-z]+\/\d+$/.test(path)).map(anchorOf);
  if (anchors.length) paste(clipboard, [0, 1].map(k => anchors.reduce((sum, at) => sum + at[k], 0) / anchors.length + [0.5, -0.5][k]));
  clipboard = kept;
}

function freeName(name) {
  const taken = new Set([...plan.rooms, ...plan.places, ...plan.zones, ...plan.furniture].map(each => each.name));
  const stem = name.replace(/ \d+$/, "");
  let free = name;
  for (let number = 2; taken.has(free); number++) free = `${stem} ${number}`;
  return free;
}
