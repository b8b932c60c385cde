// A chart of the page: a figure whose Vega specification is made anew when its width, its data or the theme changes.
import {element} from "./dom.js";
import {drawVega} from "./vega.js";

const charts = new Set();

export function redrawCharts() {
  for (const chart of charts) {
    if (chart.element.isConnected) chart.draw();
    else charts.delete(chart);
  }
}

const SERIES = ["--series-1", "--series-2", "--series-3", "--series-4", "--series-5", "--series-6", "--series-7"];

export function themeColours() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  return {
    text: colour("--text"),
    quiet: colour("--quiet"),
    line: colour("--line"),
    accent: colour("--accent"),
    surface: colour("--surface"),
    worse: colour("--worse"),
    better: colour("--better"),
    series: SERIES.map(colour),
  };
}

function config(colours) {
  const axis = {
    labelColor: colours.quiet,
    titleColor: colours.text,
    gridColor: colours.line,
    domainColor: colours.line,
    tickColor: colours.line,
    labelFontSize: 11,
    titleFontSize: 12,
    titleFontWeight: "normal",
    grid: true,
    titlePadding: 8,
    labelFont: "system-ui",
    titleFont: "system-ui",
    labelOverlap: "greedy",
  };
  return {
    axis,
    legend: {
      labelColor: colours.text,
      titleColor: colours.text,
      labelFontSize: 11,
      titleFontSize: 11,
      titleFontWeight: "normal",
      labelFont: "system-ui",
      titleFont: "system-ui",
      symbolSize: 80,
    },
    background: null,
  };
}

// makeSpec(width, colours) gives {spec, note?} or null where there is nothing to draw.
export class Chart {
  constructor({title, height, makeSpec, onClick}) {
    this.makeSpec = makeSpec;
    this.onClick = onClick;
    this.plot = element("div", {class: "plot", style: `height: ${height}px`});
    this.note = element("p", {class: "note"});
    this.element = element("figure", {class: "chart"}, element("figcaption", {}, title), this.plot, this.note);
    this.height = height;
    charts.add(this);
  }

  draw() {
    this.view?.finalize();
    this.view = undefined;
    this.element.hidden = false; // what is hidden has no width
    const width = this.plot.clientWidth;
    const colours = themeColours();
    const made = width > 0 && this.makeSpec(width, colours);
    this.element.hidden = made === null;
    if (!made) return;
    this.note.textContent = made.note ?? "";
    const size = {width, height: this.height, autosize: {type: "fit", contains: "padding"}, padding: 4};
    this.view = drawVega(
      this.plot,
      {...size, config: config(colours), description: this.element.firstChild.textContent, ...made.spec},
      this.onClick,
    );
  }
}

let pending = 0;
globalThis.addEventListener("resize", () => {
  cancelAnimationFrame(pending);
  pending = requestAnimationFrame(redrawCharts);
});

const LOG_FROM = 12; // largest over smallest value
const LOG_MARGIN = 1.15; // beyond both

const ZERO_BELOW = 0.4; // smallest over largest value
const SAME_FROM = 0.98; // likewise: no close look at next to no difference

// A logarithmic scale where values span much and are positive, one from 0 where they span some, else a close one.
export function scaleFor(values) {
  const known = values.filter((v) => Number.isFinite(v));
  const low = Math.min(...known),
    high = Math.max(...known);
  return low > 0 && high / low > LOG_FROM
    ? {type: "log", domain: [low / LOG_MARGIN, high * LOG_MARGIN]}
    : {
        type: "linear",
        zero: false,
        nice: true,
        domain: [low > ZERO_BELOW * high && low < SAME_FROM * high ? low : Math.min(low, 0), high],
      };
}

export const numberAxis = (scale, orient, title) => ({scale, orient, title, tickCount: 5, format: "~g"});
