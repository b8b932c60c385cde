// Attribution as a waterfall: each bar is what a step adds to the error of the step before.
import {Chart, numberAxis} from "./chart.js";
import {choice, element} from "./dom.js";
import {METRICS} from "./model.js";
import {decode, significant, signed} from "./numbers.js";

const WHOLE = "";

function valuesOf(steps, metric, region) {
  return steps
    .map(({step, metrics, mask_metrics: mask}) => {
      const value = (region === "mask" && mask ? mask : metrics)[metric];
      return {step, value: decode(typeof value === "object" ? value?.mean : value)};
    })
    .filter(({value}) => !Number.isNaN(value));
}

export function barsOf(steps, metric, region) {
  let before = 0;
  const bars = valuesOf(steps, metric, region).map(({step, value}) => {
    const bar = {step, from: before, to: value, change: value - before, kind: value < before ? "less" : "more"};
    before = value;
    return bar;
  });
  return bars.length ? [...bars, {step: "total", from: 0, to: before, change: before, kind: "total"}] : [];
}

function waterfallSpec(bars, metric, colours) {
  if (!bars.length) return null;
  const title = METRICS.find((m) => m.key === metric)?.title ?? metric;
  const rows = bars.map((bar) => ({
    ...bar,
    low: Math.min(bar.from, bar.to),
    high: Math.max(bar.from, bar.to),
    label: bar.kind === "total" ? significant(bar.to) : signed(bar.change),
    title: `${bar.step}: ${signed(bar.change)} (to ${significant(bar.to)})`,
  }));
  return {
    note: "A bar is the step's error minus that of the step before it; it may be negative, and all bars sum to the total.",
    spec: {
      data: [{name: "bars", values: rows}],
      scales: [
        {
          name: "y",
          type: "band",
          domain: rows.map((r) => r.step),
          range: "height",
          paddingInner: 0.25,
          paddingOuter: 0.1,
        },
        {
          name: "x",
          type: "linear",
          zero: true,
          nice: true,
          domain: {data: "bars", fields: ["low", "high"]},
          range: "width",
        },
        {
          name: "kind",
          type: "ordinal",
          domain: ["more", "less", "total"],
          range: [colours.worse, colours.better, colours.accent],
        },
      ],
      axes: [
        {scale: "y", orient: "left", grid: false, ticks: false, labelLimit: 220, labelFontSize: 12},
        numberAxis("x", "bottom", title),
      ],
      marks: [
        {
          type: "rect",
          from: {data: "bars"},
          encode: {
            update: {
              y: {scale: "y", field: "step"},
              height: {scale: "y", band: 1},
              x: {scale: "x", field: "low"},
              x2: {scale: "x", field: "high"},
              fill: {scale: "kind", field: "kind"},
              tooltip: {field: "title"},
            },
          },
        },
        {
          type: "text",
          from: {data: "bars"},
          interactive: false,
          encode: {
            update: {
              y: {scale: "y", field: "step", band: 0.5},
              x: {scale: "x", field: "high"},
              dx: {value: 5},
              baseline: {value: "middle"},
              text: {field: "label"},
              fill: {value: colours.text},
              fontSize: {value: 11},
              font: {value: "system-ui"},
            },
          },
        },
      ],
    },
  };
}

const techniqueOf = (attribution, view) =>
  view.axes.map((axis) => `${axis.name}=${attribution.technique[axis.name]}`).join(" ");

// The waterfalls of the scene that is shown; null if none was measured.
export function waterfallPanel(context) {
  const view = context.view();
  const all = (context.model.attribution ?? []).filter((a) => a.scene === view.scene && a.camera === view.camera);
  if (!all.length) return null;
  let chosen = all[0],
    object = WHOLE;
  const steps = () => (object === WHOLE ? chosen.steps : chosen.objects.find((o) => o.object === object).steps);
  const chart = new Chart({
    title: "Where the error comes from",
    height: 60 + 38 * (chosen.steps.length + 1),
    makeSpec: (width, colours) =>
      waterfallSpec(
        barsOf(steps(), context.question().metric, object === WHOLE ? context.question().region : "whole"),
        context.question().metric,
        colours,
      ),
  });
  const controls = element("div", {class: "controls"});
  const rebuild = () => {
    const objects = [...(chosen.objects ?? [])];
    controls.replaceChildren(
      choice(
        "Technique",
        all.map((a, i) => ({value: String(i), title: `frame ${a.frame}, ${techniqueOf(a, view)}`})),
        String(all.indexOf(chosen)),
        (i) => {
          chosen = all[Number(i)];
          object = WHOLE;
          rebuild();
          chart.draw();
        },
      ),
      choice(
        "Part",
        [
          {value: WHOLE, title: "the picture"},
          ...objects.map((o) => ({value: o.object, title: `${o.object} (${o.pixels} pixels)`})),
        ],
        object,
        (o) => {
          object = o;
          chart.draw();
        },
      ),
    );
  };
  rebuild();
  return {element: element("div", {}, controls, chart.element), chart};
}
