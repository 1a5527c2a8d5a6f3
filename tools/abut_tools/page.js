"use strict";
function darker(colour) {
  const part = (k) => Math.round(parseInt(colour.slice(k, k + 2), 16) * 0.45);
  return "rgb(" + [part(1), part(3), part(5)].join(", ") + ")";
}
function dataset(figure, curve) {
  const colour = curve.exact ? darker(curve.colour) : curve.colour;
  const width = figure.curves.length > 5 ? 1.75 : 2.75;
  const radius = figure.points || curve.x.length < 2 ? 2 : 0;
  return {
    label: curve.label, data: curve.x.map((x, i) => ({x: x, y: curve.y[i]})),
    borderColor: colour, backgroundColor: colour, borderWidth: curve.exact ? 1.25 : width,
    borderJoinStyle: "round",  // pointed joins of zigzags would reach beyond the values
    borderDash: curve.exact ? [4, 6] : [], pointRadius: radius, pointHitRadius: 8,
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
    type: "linear", title: {display: true, text: title}, grid: {color: "#edf0f4"},
    ticks: {maxTicksLimit: 7, maxRotation: 0},
  }, more);
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
  const legend = {display: figure.legend !== false, position: "bottom", labels: labels};
  const counts = {beginAtZero: true, suggestedMax: 3, ticks: {precision: 0}};
  return new Chart(document.getElementById(figure.name), {
    type: "line",
    data: {datasets: stacked(figure.curves.map((curve) => dataset(figure, curve)))},
    options: {
      animation: false, normalized: true, parsing: false, maintainAspectRatio: false,
      interaction: {mode: "nearest", axis: "x", intersect: false},
      plugins: {legend: legend, tooltip: tooltip},
      scales: {
        x: axis("time [" + figure.time + "]", {}),
        y: axis(figure.label, figure.points ? counts : figure.floor === null ? {} : {min: 0}),
      },
    },
  });
}
function inked(canvas) {
  if (!canvas.width || !canvas.height) return false;
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  return pixels.some((value) => value !== 0);
}
Chart.defaults.font.family = 'system-ui, "DejaVu Sans", sans-serif';
Chart.defaults.color = "#4a5563";
const failures = [];
function attempt(name, action) {
  try { action(); } catch (error) { failures.push(name + ": " + error); }
}
// Tells a test, and anybody who looks, whether the page is complete.
function tell() {
  const canvases = Array.from(document.querySelectorAll("canvas"));
  document.body.dataset.figures = String(canvases.length);
  document.body.dataset.drawn = String(canvases.filter(inked).length);
  document.body.dataset.failures = failures.join("; ");
}
