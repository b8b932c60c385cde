// Error against cost, with the Pareto front.
import {Chart, numberAxis, scaleFor} from "./chart.js";
import {bars, colourScale, legend, line, metricTitle, symbols} from "./chart_parts.js";
import {COSTS, isMoreBetter, isNoiseKnown, meanError, meanInterval} from "./model.js";
import {significant, sortedValues} from "./numbers.js";
import {paretoFront} from "./pareto.js";

export const costNamed = (key) => COSTS.find((cost) => cost.key === key);

export const knownCosts = (view) =>
  COSTS.filter((cost) => view.sequences.some((s) => Number.isFinite(cost.of(s.cells[0]) ?? NaN)));

// A choice as the Pareto front sees it: less is better in both.
function choiceOf(sequence, question, cost) {
  const cell = sequence.cells[0];
  const error = meanError(sequence, question),
    [low, high] = meanInterval(sequence, question) ?? [error, error];
  const x = cost.of(cell),
    turned = isMoreBetter(question.metric);
  if (!Number.isFinite(error) || !Number.isFinite(x)) return null;
  return {
    sequence,
    isNoiseKnown: isNoiseKnown(sequence, question),
    x,
    y: error,
    low,
    high,
    xLow: cost.low?.(cell) ?? x,
    xHigh: cost.high?.(cell) ?? x,
    error: turned ? {value: -error, low: -high, high: -low} : {value: error, low, high},
    cost: {value: x, low: cost.low?.(cell) ?? x, high: cost.high?.(cell) ?? x},
  };
}

export const frontOf = (view, question, cost) =>
  paretoFront(view.sequences.map((s) => choiceOf(s, question, cost)).filter(Boolean), question);

function scatterSpec(view, question, cost, colours) {
  const choices = view.sequences.map((s) => choiceOf(s, question, cost)).filter(Boolean);
  if (choices.length < 2) return null;
  const [first, second] = view.axes.map((axis) => axis.name);
  const pointOf = (c) => ({
    x: c.x,
    y: c.y,
    low: c.low,
    high: c.high,
    xLow: c.xLow,
    xHigh: c.xHigh,
    colour: c.sequence.technique[first] ?? "–",
    shape: c.sequence.technique[second] ?? "–",
    index: c.sequence.cells.at(-1).index,
    title: `${c.sequence.label}\n${metricTitle(question)} ${significant(c.y)}\n${cost.title} ${significant(c.x)}`,
  });
  const front = paretoFront(choices, question).map(pointOf);
  const noise = choices.every((c) => c.isNoiseKnown) ? "" : " How much of these errors is noise is not known.";
  const values = choices.map(pointOf);
  const distinct = (field) => sortedValues([...new Set(values.map((v) => v[field]))]);
  const shapes = second && distinct("shape").length > 1;
  return {
    note: `${front.length} of ${choices.length} techniques are on the Pareto front: nothing is as good in both and better in one for sure.${noise} Click a point to see its picture.`,
    spec: {
      data: [
        {name: "points", values},
        {name: "front", values: front},
      ],
      scales: [
        {name: "x", ...scaleFor(values.flatMap((v) => [v.xLow, v.xHigh])), range: "width"},
        {name: "y", ...scaleFor(values.flatMap((v) => [v.low, v.high])), range: "height"},
        colourScale("colour", colours, distinct("colour")),
        {
          name: "shape",
          type: "ordinal",
          domain: distinct("shape"),
          range: ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down"],
        },
      ],
      axes: [numberAxis("x", "bottom", cost.title), numberAxis("y", "left", metricTitle(question))],
      legends: [
        ...(first ? [legend("colour", first)] : []),
        ...(shapes
          ? [
              {
                shape: "shape",
                title: second,
                orient: "bottom",
                direction: "horizontal",
                columns: 4,
                symbolFillColor: colours.quiet,
              },
            ]
          : []),
      ],
      marks: [
        line("front", {
          interpolate: {value: "step-after"},
          stroke: {value: colours.accent},
          strokeWidth: {value: 1.5},
          strokeDash: {value: [5, 3]},
        }),
        bars("points", true, colours.quiet),
        bars("points", false, colours.quiet),
        symbols(80, {
          shape: {scale: "shape", field: "shape"},
          stroke: {value: colours.surface},
          strokeWidth: {value: 1},
        }),
      ],
    },
  };
}

export function costScatter(context) {
  return new Chart({
    title: "Error against cost",
    height: 400,
    onClick: (datum) => context.openIndex(datum.index),
    makeSpec: (width, colours) => scatterSpec(context.view(), context.question(), context.cost(), colours),
  });
}
