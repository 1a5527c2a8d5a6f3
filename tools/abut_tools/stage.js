// What a reader does with the bodies: play, turn, colour, hide, ask for values at a point.
function element(id) { return document.getElementById(id); }
function valueOf(shade, q) {
  return shade.factor * (shade.least + q / 65535 * (shade.most - shade.least));
}
function fewDigits(value) {
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) :
    String(Number(value.toPrecision(3)));
}
function drawScale(stage) {
  const shade = stage.data.shades.find((each) => each.key === stage.shade);
  element("scale").hidden = !shade;
  if (!shade) return;
  const ramp = element("ramp"), context = ramp.getContext("2d");
  ramp.width = 256; ramp.height = 1;
  const stops = stage.stops(shade);
  for (let k = 0; k < 256; k++) {
    context.fillStyle = "rgb(" + rampColour(stops, k / 255).join(",") + ")";
    context.fillRect(k, 0, 1, 1);
  }
  const ends = element("scale").querySelectorAll(".ends > *");
  const cut = (bound, sign, text) => (sign * bound > 1.0001 * sign * text[0] ? text[1] : "");
  ends[0].textContent = cut(shade.least, -1, [shade.low, "≤ "]) +
    fewDigits(shade.low * shade.factor);
  ends[1].textContent = shade.label + (shade.unit ? " [" + shade.unit + "]" : "");
  ends[2].textContent = cut(shade.most, 1, [shade.high, "≥ "]) +
    fewDigits(shade.high * shade.factor);
}
function fillChoices(stage) {
  const choice = element("shade"), magnify = element("magnify");
  choice.replaceChildren(...stage.data.shades.map((shade) => new Option(shade.label, shade.key)),
    new Option("body", ""));
  choice.value = stage.shade;
  element("magnify_label").hidden = stage.data.magnify.length < 2;
  magnify.replaceChildren(...stage.data.magnify.map((factor) => new Option("× " + factor, factor)));
  magnify.value = stage.magnify;
}
function choosing(stage) {
  const choice = element("shade"), magnify = element("magnify");
  choice.addEventListener("change", () => {
    stage.shade = choice.value;
    drawScale(stage);
    showBodies(stage);
    stage.show(stage.state);
    drawGauge(stage);
    if (stage.spaceTime) stage.spaceTime.update();
  });
  magnify.addEventListener("change", () => {
    stage.magnify = Number(magnify.value);
    stage.redraw();
  });
}
function showBodies(stage) {
  const place = element("bodies_shown");
  place.replaceChildren();
  if (stage.bodies.length < 2 || stage.bodies.length > 12) return;
  for (const body of stage.bodies) {
    const chip = document.createElement("button");
    chip.type = "button";
    chip.className = "chip";
    chip.textContent = body.name;
    chip.title = "show or hide " + body.name;
    chip.style.setProperty("--c", stage.shade ? "var(--dim)" : themed(body.colour));
    chip.setAttribute("aria-pressed", String(body.shown));
    chip.addEventListener("click", () => {
      body.shown = !body.shown;
      chip.setAttribute("aria-pressed", String(body.shown));
      stage.redraw();
    });
    place.append(chip);
  }
}
function playing(stage) {
  const button = element("play"), slider = element("moment");
  const last = () => stage.data.times.length - 1;
  let timer = null;
  const stop = () => {
    clearInterval(timer);
    timer = null;
    stage.moving = false;
    button.textContent = "▶";
    button.setAttribute("aria-label", "play");
    stage.show(stage.state);
  };
  const start = () => {
    if (stage.state === last()) stage.show(0);
    stage.moving = true;
    button.textContent = "❚❚";
    button.setAttribute("aria-label", "pause");
    timer = setInterval(() => {
      if (stage.state === last()) stop(); else stage.show(stage.state + 1);
    }, Math.max(40, Math.min(250, 6000 / stage.data.times.length)));
  };
  stage.toggle = () => (timer === null ? start() : stop());
  button.addEventListener("click", stage.toggle);
  slider.addEventListener("input", () => {
    if (timer !== null) stop();
    stage.show(Number(slider.value));
  });
  stage.watchers.push(() => {
    const time = stage.data.times[stage.state];
    slider.value = stage.state;
    const text = "t = " + digits(Number(time.toPrecision(4)), stage.data.time);
    slider.setAttribute("aria-valuetext", text);
    element("now").textContent = text;
    moment.time = time;
    for (const chart of moment.charts.values()) chart.draw();
  });
}
function turning(stage) {
  const canvas = stage.canvas;
  let from = null, far = 0;
  canvas.addEventListener("pointerdown", (event) => {
    from = [event.clientX, event.clientY];
    far = 0;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return;
    const x = event.clientX - from[0], y = event.clientY - from[1];
    far += Math.hypot(x, y);
    from = [event.clientX, event.clientY];
    if (stage.data.dimension === 3 && !event.shiftKey) turn(stage, -0.008 * x, 0.008 * y);
    else stage.shift = [stage.shift[0] + x, stage.shift[1] + y];
    stage.moving = true;
    stage.redraw();
  });
  canvas.addEventListener("pointerup", (event) => {
    if (from && far < 4) ask(stage, event.offsetX, event.offsetY);
    from = null;
    stage.moving = element("play").getAttribute("aria-label") === "pause";
    stage.redraw();
  });
  canvas.addEventListener("pointercancel", () => { from = null; });
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;  // the page scrolls
    event.preventDefault();
    zoom(stage, Math.exp(-0.002 * event.deltaY));
  }, {passive: false});
  canvas.addEventListener("dblclick", () => { stage.home(); stage.redraw(); });
  const keys = {
    ArrowLeft: () => turn(stage, 0.1, 0), ArrowRight: () => turn(stage, -0.1, 0),
    ArrowUp: () => turn(stage, 0, 0.1), ArrowDown: () => turn(stage, 0, -0.1),
    "+": () => zoom(stage, 1.2), "-": () => zoom(stage, 1 / 1.2), " ": () => stage.toggle(),
    Home: () => stage.home(),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
    stage.redraw();
  });
}
function turn(stage, a, e) {
  if (stage.data.dimension < 3) return;
  const steep = Math.max(-1.57, Math.min(1.57, stage.turn[1] + e));
  stage.turn = [stage.turn[0] + a, steep];
}
function zoom(stage, factor) {
  stage.zoom = Math.max(0.2, Math.min(200, stage.zoom * factor));
  stage.shift = stage.shift.map((each) => each * factor);
  stage.redraw();
}
function ask(stage, x, y) {
  stage.gauge = stage.nearest(x, y);
  drawGauge(stage);
  stage.redraw();
}
// Values of the chosen quantity at one node: a gauge that a reader puts where he wants it.
function drawGauge(stage) {
  const shade = stage.data.shades.find((each) => each.key === stage.shade);
  const at = stage.gauge;
  if (stage.gaugeChart) {
    stage.gaugeChart.destroy();
    moment.charts.delete("gauge");
    stage.gaugeChart = null;
  }
  const there = at && shade && at.body.keys.includes(shade.key);
  element("gauge_figure").hidden = !there;
  if (!there) return;
  const axes = stage.data.dimension, place = Array.from(at.body.rest.slice(3 * at.node,
    3 * at.node + (axes === 1 ? 1 : axes)), fewDigits);
  element("gauge_title").textContent = shade.label + " of " + at.body.name + " at (" +
    place.join(", ") + ") m of its shape at rest";
  const values = at.body.values[shade.key].map((row) => valueOf(shade, row[at.node]));
  stage.gaugeChart = draw({name: "gauge", label: shade.label.split(",")[0] +
    (shade.unit ? " [" + shade.unit + "]" : ""), unit: shade.unit, points: false,
    time: stage.data.time, floor: null, legend: false, moment: true, curves: [{label:
    at.body.name, colour: at.body.colour, exact: false, x: stage.data.times, y: values}]});
}
// Places of bars over time: between two states their cells are parallelograms in this plane.
function paintSpaceTime(stage, chart) {
  const {left, top, width, height} = chart.chartArea, x = chart.scales.x, y = chart.scales.y;
  const ratio = Math.min(2, window.devicePixelRatio || 1);
  const w = Math.round(width * ratio), h = Math.round(height * ratio);
  if (w < 2 || h < 2) return;
  const sheet = document.createElement("canvas");
  sheet.width = w; sheet.height = h;
  const picture = new Picture(w, h), times = stage.data.times, factor = stage.data.length.factor;
  picture.clear();
  const row = (place) => (y.getPixelForValue(place * factor) - top) * ratio;
  const columns = times.map((time) => (x.getPixelForValue(time) - left) * ratio);
  for (const body of stage.bodies.filter((each) => each.strip && each.triangles.length)) {
    const shade = stage.shadeOf(body), n = body.nodes / 2;
    const colours = shade ? stage.colours(shade) : stage.one(themed(body.colour));
    const from = shade ? shade.least : 0, span = shade ? (shade.most - shade.least) / 65535 : 0;
    const level = (state, k) => shade ?
      levelOf(shade, from + body.values[shade.key][state][k] * span) : 0;
    const place = (state, k) => row(body.rest[3 * k] + body.means[state][0] +
      body.reach * (body.moved[0][state][k] / 32767.5 - 1));
    const first = (LEVELS - 1) * 256, p = new Float32Array(12);
    for (let s = 0; s + 1 < times.length; s++) {
      for (let k = 0; k + 1 < n; k++) {
        p.set([columns[s], place(s, k), 0, columns[s], place(s, k + 1), 0,
          columns[s + 1], place(s + 1, k), 0, columns[s + 1], place(s + 1, k + 1), 0]);
        const v = [level(s, k), level(s, k + 1), level(s + 1, k), level(s + 1, k + 1)];
        picture.triangle(p, 0, 1, 2, colours, first, v[0], v[1], v[2]);
        picture.triangle(p, 1, 3, 2, colours, first, v[1], v[3], v[2]);
      }
    }
  }
  sheet.getContext("2d").putImageData(picture.image, 0, 0);
  chart.ctx.drawImage(sheet, left, top, width, height);
}
function drawSpaceTime(stage) {
  const canvas = element("space_time");
  if (!canvas || stage.data.dimension !== 1) return;
  const {low, high, times, length} = stage.data;
  if (stage.spaceTime) stage.spaceTime.destroy();
  stage.spaceTime = new Chart(canvas, {
    type: "scatter", data: {datasets: []},
    options: {
      animation: false, maintainAspectRatio: false, moment: true, events: ["click"],
      plugins: {legend: {display: false}},
      scales: {
        x: axis("time [" + stage.data.time + "]", {min: times[0], max: times[times.length - 1],
          ticks: {maxTicksLimit: 7, maxRotation: 0, includeBounds: false}}),
        y: axis("place [" + length.unit + "]",
          {min: low[0] * length.factor, max: high[0] * length.factor,
            ticks: {maxTicksLimit: 7, includeBounds: false}}),
      },
      onClick: (event, items, chart) => goTo(stage, chart, event),
    },
    plugins: [{id: "sheet", beforeDatasetsDraw: (chart) => paintSpaceTime(stage, chart)}],
  });
  moment.charts.set("space_time", stage.spaceTime);
}
function goTo(stage, chart, event) {
  const wanted = chart.scales.x.getValueForPixel(event.x);
  const far = (time) => Math.abs(time - wanted);
  let best = 0;
  stage.data.times.forEach((time, k) => { if (far(time) < far(stage.data.times[best])) best = k; });
  stage.show(best);
}
async function openStage(data) {
  const stage = new Stage(data, await unpacked(data.block));
  stage.canvas.parentElement.style.setProperty("--aspect", stage.data.aspect);
  fillChoices(stage);
  choosing(stage);
  showBodies(stage);
  playing(stage);
  turning(stage);
  drawScale(stage);
  drawSpaceTime(stage);
  moment.go = (chart, event) => goTo(stage, chart, event);
  new ResizeObserver(() => stage.redraw()).observe(stage.canvas);
  followTheme(() => {
    stage.tables = {};
    drawScale(stage);
    showBodies(stage);
    drawSpaceTime(stage);
    drawGauge(stage);
    stage.show(stage.state);
  });
  stage.show(data.start);
  stage.draw();
  return stage;
}
