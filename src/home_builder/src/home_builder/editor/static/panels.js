"use strict";
// The panels beside the drawing: fields of what is selected, problems, rooms, the template, and what was built.

function status(text, isError = false) {
  $("saved").textContent = text;
  $("saved").className = isError ? "error" : "";
}

function showFields() {
  const path = single(), item = path && itemOf(path);
  $("fields").replaceChildren();
  $("chosen").textContent = path ? path.split("/").slice(-2)[0].replace(/s$/, "") : selection.length ? `${selection.length} items` : "Home";
  if (tool === "wall") {
    $("chosen").textContent = "Next walls";
    return ["thickness", "height"].forEach(name => field(name, newWall[name], value => { if (value > 0) newWall[name] = value; }));
  }
  if (selection.length > 1) return;
  if (!item) return field("name", plan.name, value => { plan.name = value || "home"; });
  if (item.end) field("length", rounded(wallLength(item)), value => { if (value > 0) item.end = alongWall(item, value).map(rounded); });
  for (const [name, value] of Object.entries(item)) {
    if (name === "yaw") field("yaw, degrees", Math.round(value * 18000 / Math.PI) / 100, degrees => { item.yaw = rounded(wrapped(degrees * Math.PI / 180)); });
    else if (name === "size") ["width", "depth", "height"].forEach((each, k) => field(each, value[k], side => { if (side > 0) item.size[k] = side; }));
    else if (typeof value === "number" || name === "name") field(name, value, given => { item[name] = given; });
  }
  if (item.kind && item.size && item.name === undefined) field("name", "", value => { if (value) item.name = value; });
}

function field(name, value, set) {
  const row = document.createElement("label"), input = document.createElement("input");
  row.textContent = name;
  input.value = value;
  input.dataset.field = name;
  input.addEventListener("change", () => {
    const given = typeof value === "number" ? Number(input.value.replace(",", ".")) : input.value.trim();
    if (given === "" && value !== "" || Number.isNaN(given)) { input.value = value; return; }
    change(() => set(given));
  });
  input.addEventListener("keydown", event => { 
    if (event.key === "Escape") input.value = value;
    if (event.key === "Enter" || event.key === "Escape") svg.focus();
  });
  row.appendChild(input);
  $("fields").appendChild(row);
}

function showJudged() {
  $("problems").replaceChildren(...judged.problems.map(problem => {
    const line = document.createElement("li");
    line.textContent = problem.text;
    line.className = problem.is_error ? "error" : "";
    line.addEventListener("click", () => { Object.assign(view, { x: problem.x, y: problem.y }); draw(); });
    return line;
  }));
  $("rooms").replaceChildren(...judged.rooms.map(room => {
    const line = document.createElement("li");
    line.textContent = `${room.name}: ${room.area.toFixed(1)} m²`;
    return line;
  }));
}

// -- the template ------------------------------------------------------------------------------------------------

async function loadTemplate(file) {
  if (!file) return;
  if (file.size > MAX_TEMPLATE) return status(`${file.name} has more than ${MAX_TEMPLATE >> 20} MB; reduce the picture`, true);
  try {
    const { template } = await request("PUT", "/template", file);
    const { x, y } = view;
    Object.assign(template, { x: rounded(x - template.width * template.scale / 2), y: rounded(y - template.height * template.scale / 2) });
    change(() => { plan.template = template; });
    choose("scale");
  } catch (error) {
    status(error.message, true);
  }
}

function withTemplate(act) {
  return () => plan.template ? act() : status("choose a picture first", true);
}

async function trace() {
  $("output").textContent = "looking for walls ...";
  while (saving) await saving;
  try {
    const { found } = await request("POST", "/trace");
    const traced = fromFile(found);
    selection = [];
    change(() => {
      if (!plan.walls.length) plan.start = traced.start;
      for (const list of LISTS) for (const item of traced[list]) add(list, item);
    });
    $("output").textContent = `found ${traced.walls.length} walls and ${traced.furniture.length} pieces of furniture`;
  } catch (error) {
    $("output").textContent = error.message;
  }
}

// -- what is built ------------------------------------------------------------------------------------------------

async function act(path, text) {
  $("output").textContent = text;
  $("link").replaceChildren();
  while (saving) await saving;
  try {
    const answer = await request("POST", path);
    $("output").textContent = answer.text || ["built", ...(answer.remarks || [])].join("\n");
    if (answer.url) {
      const link = document.createElement("a");
      Object.assign(link, { href: answer.url, target: "_blank", rel: "noopener", textContent: "Open the robot's page" });
      $("link").replaceChildren(link);
      $("output").textContent = "the robot stands at the start: drive it by hand, or send it on a mission";
    }
    $("map").src = `/map.png?${Date.now()}`;
    $("map").hidden = false;
  } catch (error) {
    $("output").textContent = error.message;
  }
}
