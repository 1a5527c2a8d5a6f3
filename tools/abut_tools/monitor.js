// A run as it goes on: asks once a second for what has come since, and shows it.
const HEARTBEAT = 1000, RESTING = 5000;  // ms between two questions; of a page that nobody sees
const seen = {version: 0, latest: "-inf", moving: 0, stage: null, bodies: null, fetching: false,
  figures: {}, events: -1};
function made(kind, text, name) {
  const node = document.createElement(kind);
  if (text !== undefined) node.textContent = text;
  if (name) node.className = name;
  return node;
}
function tableOf(heads, rows, ill) {
  const table = made("table"), head = made("tr");
  head.append(...heads.map((text) => made("th", text)));
  table.append(made("thead"), made("tbody"));
  table.tHead.append(head);
  for (const row of rows) {
    const line = made("tr", undefined, ill.includes(row[0]) ? "failed" : "");
    line.append(...row.map((text) => made("td", text)));
    table.tBodies[0].append(line);
  }
  return table;
}
// What has not changed stays, so that a text that somebody has marked stays marked.
function replace(place, nodes) {
  const fresh = made("div");
  fresh.append(...nodes);
  if (fresh.innerHTML !== place.innerHTML) place.replaceChildren(...fresh.childNodes);
}
function text(id, words) {
  if (element(id).textContent !== words) element(id).textContent = words;
}
function showStatus(told) {
  const [words, kind, sentence] = told.badge, part = told.part;
  const percent = part === null ? "" : (100 * part).toFixed(1) + " %";
  text("title", told.title);
  text("badge", words);
  element("badge").className = "badge " + kind;
  const behind = told.read < 0.98 ? " Records are being read: figures are of the first " +
    Math.floor(100 * told.read) + " % of what is written." : "";
  text("sentence", sentence + behind + (told.trouble ? " " + told.trouble : ""));
  text("percent", percent);
  if (part === null) element("far").removeAttribute("value"); else element("far").value = part;
  const running = percent && !told.ended;
  document.title = (running ? percent.replace(".0", "") + ", " : words + ", ") + told.title;
  replace(element("facts"), told.facts.map(([name, value]) => {
    const pair = made("div");
    pair.append(made("dt", name), made("dd", value));
    return pair;
  }));
}
const SHARES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d1f", "#5b5b5b"];
function showShares(shares) {
  element("shares_section").hidden = !shares.length;
  const named = (share) => share.name + " " + Math.round(100 * share.part) + " %";
  const colour = (share, k) => share.name === "coupling" && k === shares.length - 1 ?
    "var(--line)" : themed(SHARES[k % SHARES.length]);
  element("shares").setAttribute("aria-label", "Shares of the time: " +
    shares.map(named).join(", "));
  replace(element("shares"), shares.map((share, k) => {
    const bar = made("span");
    bar.style.width = (100 * share.part).toFixed(1) + "%";
    bar.style.background = colour(share, k);
    bar.title = named(share);
    return bar;
  }));
  replace(element("share_names"), shares.slice(0, 12).map((share, k) => {
    const item = made("li", named(share));
    item.style.setProperty("--c", colour(share, k));
    return item;
  }));
}
function showBodiesTable(told) {
  element("bodies_section").hidden = !told.bodies.rows.length;
  const more = told.bodies.more ? [made("p", "and " + told.bodies.more + " more", "note")] : [];
  replace(element("health"), [tableOf(told.bodies.heads, told.bodies.rows, told.bodies.ill),
    ...more]);
  text("coordinator", told.coordinator);
}
function showEvents(told) {
  text("event_note", (told.event_count ? told.event_count + " so far" : "None so far") +
    (told.warnings ? ", " + told.warnings + " of them warnings" : "") + ".");
  const key = told.reborn + "/" + told.event_count;
  if (seen.events === key) return;
  seen.events = key;
  const table = tableOf(["time", "event", "of", ""], told.events.map((event) =>
    [event.time, event.kind, event.subject, event.text]), []);
  Array.from(table.tBodies[0].rows).forEach((row, k) => {
    const kind = told.events[k].kind;
    row.className = kind === "failure" ? "failed" : kind === "warning" ? "warned" : "";
  });
  element("events").replaceChildren(...(told.events.length ? [table] : []));
}
// ---- curves ----------------------------------------------------------------------------
function place(figure) {  // of a figure that was not there
  const node = made("figure"), canvas = made("canvas"), plot = made("div", undefined, "plot");
  canvas.id = "figure_" + figure.name;
  canvas.setAttribute("role", "img");
  plot.append(canvas);
  node.append(made("figcaption", figure.title), plot);
  element("figures").append(node);
  return node;
}
function drawAnew(held) {
  if (held.chart) held.chart.destroy();
  held.node.querySelector("figcaption").textContent = held.figure.title;
  held.chart = draw({...held.figure, name: "figure_" + held.figure.name});
}
// Beside the bodies stands the force, with a line at their time.
function settle(held, beside) {
  const there = beside && seen.stage !== null && seen.stage.data.dimension > 1;
  if (held.figure.moment === there) return;
  held.figure.moment = there;
  element(there ? "beside" : "figures").prepend(held.node);
  moment.charts.delete("figure_" + held.figure.name);
  drawAnew(held);
}
function showFigures(figures, beside) {
  for (const [name, held] of Object.entries(seen.figures)) {
    if (figures.some((figure) => figure.name === name)) continue;
    held.chart.destroy();
    held.node.remove();
    delete seen.figures[name];
  }
  for (const figure of figures) {
    let held = seen.figures[figure.name];
    if (!held) held = seen.figures[figure.name] = {node: place(figure), chart: null};
    if (held.figure && !figure.whole) {
      add(held, figure);
    } else {
      figure.moment = held.figure ? held.figure.moment : false;
      held.figure = figure;
      drawAnew(held);
    }
    settle(held, figure.name === beside);
  }
  element("no_figures").hidden = figures.length > 0;
}
function add(held, figure) {
  held.node.querySelector("canvas").setAttribute("aria-label", figure.words);
  if (!figure.curves.some((curve) => curve.x.length)) return;
  if (figure.floor !== held.figure.floor) {
    held.figure.floor = figure.floor;
    held.chart.options.scales.y.min = figure.floor === null ? undefined : 0;
  }
  figure.curves.forEach((curve, k) => {
    const whole = held.figure.curves[k], data = held.chart.data.datasets[k].data;
    curve.x.forEach((x, i) => {
      whole.x.push(x);
      whole.y.push(curve.y[i]);
      data.push({x: x, y: curve.y[i]});
    });
  });
  held.chart.update("none");
}
// ---- bodies ----------------------------------------------------------------------------
async function showMoving(told) {
  if (told.moving === seen.moving || seen.fetching) return;
  seen.fetching = true;
  try {
    const answer = await (await fetch("bodies")).json();
    await takeBodies(answer.data, told.windows);
    seen.moving = answer.version;
  } finally {
    seen.fetching = false;
  }
}
async function takeBodies(data, windows) {
  element("stage_place").hidden = !data;
  element("space_time_figure").hidden = !data || data.dimension !== 1 || data.times.length < 3;
  if (!data) {
    const every = Math.max(1, Math.round(windows / 100));
    text("how", "No states of the bodies are on the disk. A run writes them with --set " +
      "output.fields.every=" + every + ", or with that key in its scene.");
    return;
  }
  text("how", data.words);
  element("bodies").setAttribute("aria-label", data.alternative);
  element("moment").max = data.times.length - 1;
  if (!seen.stage) {
    seen.stage = await openStage(data);
    return;
  }
  renew(seen.stage, data, await unpacked(data.block));
}
// Whoever looks at the latest state goes on with the run; whoever looks back stays there.
function renew(stage, data, buffer) {
  const time = stage.data.times[stage.state], live = stage.state === stage.data.times.length - 1;
  const hidden = stage.bodies.filter((body) => !body.shown).map((body) => body.name);
  const at = stage.gauge, playing = stage.moving;
  stage.take(data, buffer);
  stage.tables = {};
  for (const body of stage.bodies) body.shown = !hidden.includes(body.name);
  if (stage.shade && !data.shades.some((shade) => shade.key === stage.shade)) {
    stage.shade = data.shades.length ? data.shades[0].key : "";
  }
  if (!data.magnify.includes(stage.magnify)) stage.magnify = 1;
  const body = at && stage.bodies.find((each) => each.name === at.body.name);
  stage.gauge = body && body.nodes === at.body.nodes ? {body: body, node: at.node} : null;
  fillChoices(stage);
  showBodies(stage);
  drawScale(stage);
  drawSpaceTime(stage);
  drawGauge(stage);
  const later = data.times.findIndex((each) => each >= time);
  stage.show(live && !playing || later < 0 ? data.times.length - 1 : later);
}
// ---- the watch -------------------------------------------------------------------------
function show(told) {
  if (told.version < seen.version) {  // another monitor stands there
    Object.assign(seen, {version: 0, latest: "-inf", moving: 0, events: -1});
    return;
  }
  showStatus(told);
  showShares(told.shares);
  showBodiesTable(told);
  showEvents(told);
  showFigures(told.figures, told.beside);
  seen.version = told.version;
  seen.latest = told.latest === null ? "-inf" : String(told.latest);
}
async function look() {
  try {
    const query = "state?since=" + seen.version + "&until=" + seen.latest;
    const answer = await fetch(query);
    if (!answer.ok) throw new Error(await answer.text());
    const told = await answer.json();
    element("lost").hidden = !told.fault;
    if (told.fault) {
      text("lost", "The run's folder cannot be read as it is; below is what it told before. " +
        told.fault);
    } else {
      show(told);
      await showMoving(told);
    }
  } catch (error) {
    element("lost").hidden = false;
    text("lost", "The monitor does not answer: it has been ended, or the way to it is cut. What " +
      "is below is what it told last. (" + error.message + ")");
  }
  document.body.dataset.looks = String(Number(document.body.dataset.looks || 0) + 1);
}
async function watch() {
  themeCharts();
  followTheme(() => Object.values(seen.figures).forEach(drawAnew));
  for (;;) {
    await look();
    await new Promise((done) => {
      const timer = setTimeout(done, document.hidden ? RESTING : HEARTBEAT);
      document.addEventListener("visibilitychange", () => {
        if (!document.hidden) { clearTimeout(timer); done(); }
      }, {once: true});
    });
  }
}
