"use strict";
const scheme = window.matchMedia("(prefers-color-scheme: dark)");
function style(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
function mixed(colour, other, part) {
  const at = (text, k) => parseInt(text.slice(k, k + 2), 16);
  return "#" + [1, 3, 5].map((k) => Math.round(at(colour, k) + part * (at(other, k) -
    at(colour, k))).toString(16).padStart(2, "0")).join("");
}
// Colours are chosen for white; on a dark page they are lighter.
function themed(colour) { return scheme.matches ? mixed(colour, "#ffffff", 0.38) : colour; }
function darker(colour) {
  return scheme.matches ? mixed(colour, "#ffffff", 0.75) : mixed(colour, "#000000", 0.55);
}
function followTheme(action) { scheme.addEventListener("change", action); }
// The time that the bodies beside the curves are shown at.
const moment = {time: null, charts: new Map(), go: null};
const charts = {};
const DASHES = [[], [7, 4], [2, 3]];  // of the axes x, y, z
function dataset(figure, curve) {
  const colour = curve.exact ? darker(curve.colour) : themed(curve.colour);
  const width = figure.curves.length > 5 ? 1.75 : 2.75;
  const radius = figure.points || curve.x.length < 2 ? 2 : 0;
  return {
    label: curve.label, data: curve.x.map((x, i) => ({x: x, y: curve.y[i]})),
    borderColor: colour, backgroundColor: colour, borderWidth: curve.exact ? 1.25 : width,
    borderJoinStyle: "round",  // pointed joins of zigzags would reach beyond the values
    borderDash: curve.exact ? [4, 6] : DASHES[curve.dash || 0], pointRadius: radius,
    pointHitRadius: 8,
    pointHoverRadius: 4, showLine: !figure.points, order: curve.exact ? 0 : 1, tension: 0,
  };
}
// Rough curves lie behind calm ones, the exact one lies on top of all.
function stacked(sets) {
  const roughness = (set) => set.data.reduce((sum, point, i) =>
    sum + (i ? Math.abs(point.y - set.data[i - 1].y) : 0), 0);
  const ranks = sets.filter((set) => set.order > 0).map((set) => [roughness(set), set]);
  ranks.sort((one, other) => one[0] - other[0]).forEach(([, set], i) => { set.order = i + 1; });
  return sets;
}
function axis(title, more) {
  return Object.assign({
    type: "linear", title: {display: true, text: title}, grid: {color: style("--line")},
    ticks: {maxTicksLimit: 7, maxRotation: 0, callback: tickText},
  }, more);
}
// Axes of round-off: 2e-13, not all the zeros that Chart.js would write.
function tickText(value, index, ticks) {
  const largest = Math.max(...ticks.map((tick) => Math.abs(tick.value)));
  if (largest === 0 || (largest >= 1e-3 && largest < 1e7)) {
    return Chart.Ticks.formatters.numeric.call(this, value, index, ticks);
  }
  return value === 0 ? "0" : Number(value.toPrecision(6)).toExponential().replace("e+", "e");
}
function digits(value, unit) {
  return Number(value.toPrecision(6)).toString() + (unit ? " " + unit : "");
}
function draw(figure) {
  const tooltip = {
    callbacks: {
      title: (items) => items.length ? "t = " + digits(items[0].parsed.x, figure.time) : "",
      label: (item) => " " + item.dataset.label + ": " + digits(item.parsed.y, figure.unit),
    },
  };
  const labels = {
    usePointStyle: true, pointStyle: "line", pointStyleWidth: 30,
    // A dot has no dashes of its own: the name shows those of its curve.
    generateLabels: (chart) => Chart.defaults.plugins.legend.labels.generateLabels(chart).map(
      (item) => Object.assign(item, {lineDash: chart.data.datasets[item.datasetIndex].borderDash})),
    sort: (one, other) => one.datasetIndex - other.datasetIndex,
  };
  const alone = figure.curves.length === 1 && !figure.curves[0].label;
  const legend = {display: figure.legend !== false && !alone, position: "bottom", labels: labels};
  const counts = {beginAtZero: true, suggestedMax: 3, ticks: {precision: 0, callback: tickText}};
  const canvas = document.getElementById(figure.name);
  if (figure.words) canvas.setAttribute("aria-label", figure.words);
  const chart = new Chart(canvas, {
    type: "line",
    data: {datasets: stacked(figure.curves.map((curve) => dataset(figure, curve)))},
    options: {
      animation: false, normalized: true, parsing: false, maintainAspectRatio: false,
      interaction: {mode: "nearest", axis: "x", intersect: false},
      plugins: {legend: legend, tooltip: tooltip}, moment: figure.moment === true,
      onClick: (event, items, one) => {
        if (figure.moment && moment.go) moment.go(one, event);
      },
      scales: {
        x: axis(figure.time ? "time [" + figure.time + "]" : "time", {}),
        y: axis(figure.label, figure.points ? counts : figure.floor === null ? {} : {min: 0}),
      },
    },
  });
  if (figure.moment) moment.charts.set(figure.name, chart);
  return chart;
}
Chart.register({
  id: "moment",
  afterDraw: (chart) => {
    if (moment.time === null || !chart.options.moment) return;
    const {left, right, top, bottom} = chart.chartArea, context = chart.ctx;
    const x = chart.scales.x.getPixelForValue(moment.time);
    if (x < left - 1 || x > right + 1) return;
    context.save();
    context.strokeStyle = style("--ink");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, bottom);
    context.stroke();
    context.restore();
  },
});
function inked(canvas) {
  if (!canvas.width || !canvas.height) return false;
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  return pixels.some((value) => value !== 0);
}
function themeCharts() {
  Chart.defaults.font.family = 'system-ui, "DejaVu Sans", sans-serif';
  Chart.defaults.color = style("--soft");
}
followTheme(themeCharts);
const failures = [];
function attempt(name, action) {
  try { action(); } catch (error) { failures.push(name + ": " + error); }
}
// Tells a test, and anybody who looks, whether the page is complete.
function tell() {
  const canvases = Array.from(document.querySelectorAll("main canvas")).filter(
    (canvas) => canvas.clientWidth > 0);  // what is hidden is not drawn yet
  const page = document.documentElement;
  if (page.scrollWidth > page.clientWidth + 1) failures.push("the page is wider than its window");
  document.body.dataset.figures = String(canvases.length);
  document.body.dataset.drawn = String(canvases.filter(inked).length);
  document.body.dataset.failures = failures.join("; ");
}
