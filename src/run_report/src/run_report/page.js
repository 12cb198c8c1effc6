"use strict";
(() => {
  const run = JSON.parse(document.getElementById("run").textContent);
  const slider = document.getElementById("time"), button = document.getElementById("play");
  const now = document.getElementById("now"), robot = document.querySelector(".robot");
  const objects = [...document.querySelectorAll(".object")].map((object) => (
    [object, run.markings.filter((marking) => marking[1] === object.dataset.name)]));
  const cursors = [...document.querySelectorAll(".plot")].map((plot) => {
    const cursor = document.createElement("div");
    cursor.className = "cursor";
    plot.append(cursor);
    plot.addEventListener("pointermove", (event) => {
      const box = plot.getBoundingClientRect();
      show(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * run.end);
    });
    return cursor;
  });
  let frame = 0, latest = 0;

  const before = (rows, time) => { // index of the last row that is not after time, or -1
    let low = -1, high = rows.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (rows[middle][0] <= time) low = middle; else high = middle;
    }
    return low;
  };

  const show = (time) => {
    slider.value = time;
    const [, x, y, yaw] = run.truth[Math.max(0, before(run.truth, time))];
    robot.setAttribute("transform", `translate(${x} ${-y}) rotate(${-yaw * 180 / Math.PI})`);
    for (const [object, markings] of objects) {
      const marking = markings[before(markings, time)];
      object.setAttribute("visibility", marking && marking[2] ? "visible" : "hidden");
      if (marking) object.setAttribute("transform", `translate(${marking[3]} ${-marking[4]})`);
    }
    const error = run.errors[before(run.errors, time)];
    const state = run.states[before(run.states, time)];
    now.textContent = `${time.toFixed(1)} s` + (error ? `, off ${error[1].toFixed(3)} m` : "");
    now.title = state ? state[1] : "";
    for (const cursor of cursors) cursor.style.left = `${100 * time / run.end}%`;
  };

  const stop = () => {
    cancelAnimationFrame(frame);
    frame = 0;
    button.textContent = "▶";
  };
  const step = (stamp) => {
    const time = Number(slider.value) + 4 * (stamp - latest) / 1000;
    latest = stamp;
    show(Math.min(time, run.end));
    if (time < run.end) frame = requestAnimationFrame(step); else stop();
  };
  button.addEventListener("click", () => {
    if (frame) return stop();
    if (Number(slider.value) >= run.end) show(0);
    button.textContent = "❚❚";
    latest = performance.now();
    frame = requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => show(Number(slider.value)));
  for (const box of document.querySelectorAll("input[data-kind]")) {
    box.addEventListener("change", () => {
      for (const path of document.querySelectorAll(`.path.${box.dataset.kind}`)) path.style.display = box.checked ? "" : "none";
    });
  }
  show(run.end);
})();
