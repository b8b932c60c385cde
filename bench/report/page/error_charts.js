// Charts of errors: against cost with the Pareto front, against each axis of the technique, over time and against staleness.
import {Chart, numberAxis, scaleFor} from "./chart.js";
import {COSTS, METRICS, errorOf, faceAgeOf, intervalOf, isMoreBetter, meanError, meanInterval} from "./model.js";
import {significant, sortedValues} from "./numbers.js";
import {paretoFront} from "./pareto.js";

const metricTitle = ({metric, region, truth}) =>
  `${METRICS.find((m) => m.key === metric).title}, ${region === "mask" ? "mask" : "whole image"}${truth === "matched" ? ", own bounces" : ""}`;

const isNumeric = (values) => values.every((v) => v !== "" && Number.isFinite(Number(v)));

function legend(name, title) {
  return {fill: name, title, orient: "bottom", direction: "horizontal", columns: 4, offset: 6};
}

const colourScale = (name, colours, values) => ({name, type: "ordinal", domain: values, range: colours.series});

// --- Error against cost

// A choice as the Pareto front sees it: less is better in both.
function choiceOf(sequence, question, cost) {
  const cell = sequence.cells[0];
  const error = meanError(sequence, question), [low, high] = meanInterval(sequence, question) ?? [error, error];
  const x = cost.of(cell), turned = isMoreBetter(question.metric);
  if (!Number.isFinite(error) || !Number.isFinite(x)) return null;
  return {
    sequence, x, y: error, low, high, xLow: cost.low?.(cell) ?? x, xHigh: cost.high?.(cell) ?? x,
    error: turned ? {value: -error, low: -high, high: -low} : {value: error, low, high},
    cost: {value: x, low: cost.low?.(cell) ?? x, high: cost.high?.(cell) ?? x},
  };
}

export const frontOf = (view, question, cost) =>
  paretoFront(view.sequences.map((s) => choiceOf(s, question, cost)).filter(Boolean));

function bars(data, horizontal, colour) {
  const along = horizontal ? {x: {scale: "x", field: "xLow"}, x2: {scale: "x", field: "xHigh"}, y: {scale: "y", field: "y"}}
    : {y: {scale: "y", field: "low"}, y2: {scale: "y", field: "high"}, x: {scale: "x", field: "x"}};
  return {type: "rule", from: {data}, interactive: false, encode: {update: {...along, stroke: {value: colour}, strokeOpacity: {value: 0.6}}}};
}

function scatterSpec(view, question, cost, colours) {
  const choices = view.sequences.map((s) => choiceOf(s, question, cost)).filter(Boolean);
  if (choices.length < 2) return null;
  const [first, second] = view.axes.map((axis) => axis.name);
  const pointOf = (c) => ({x: c.x, y: c.y, low: c.low, high: c.high, xLow: c.xLow, xHigh: c.xHigh,
    colour: c.sequence.technique[first] ?? "–", shape: c.sequence.technique[second] ?? "–", index: c.sequence.cells.at(-1).index,
    title: `${c.sequence.label}\n${metricTitle(question)} ${significant(c.y)}\n${cost.title} ${significant(c.x)}`});
  const front = paretoFront(choices).map(pointOf);
  const values = choices.map(pointOf);
  const distinct = (field) => sortedValues([...new Set(values.map((v) => v[field]))]);
  const shapes = second && distinct("shape").length > 1;
  return {
    note: `${front.length} of ${choices.length} techniques are on the Pareto front: nothing is as good and better in one by more than the intervals. Click a point to see its picture.`,
    spec: {
      data: [{name: "points", values}, {name: "front", values: front}],
      scales: [
        {name: "x", ...scaleFor(values.flatMap((v) => [v.xLow, v.xHigh])), range: "width"},
        {name: "y", ...scaleFor(values.flatMap((v) => [v.low, v.high])), range: "height"},
        colourScale("colour", colours, distinct("colour")),
        {name: "shape", type: "ordinal", domain: distinct("shape"), range: ["circle", "square", "triangle-up", "diamond", "cross", "triangle-down"]},
      ],
      axes: [numberAxis("x", "bottom", cost.title), numberAxis("y", "left", metricTitle(question))],
      legends: [...(first ? [legend("colour", first)] : []), ...(shapes ? [{shape: "shape", title: second, orient: "bottom", direction: "horizontal", columns: 4, symbolFillColor: colours.quiet}] : [])],
      marks: [
        {type: "line", from: {data: "front"}, interactive: false, encode: {update: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
          interpolate: {value: "step-after"}, stroke: {value: colours.accent}, strokeWidth: {value: 1.5}, strokeDash: {value: [5, 3]}}}},
        bars("points", true, colours.quiet), bars("points", false, colours.quiet),
        {type: "symbol", from: {data: "points"}, encode: {
          update: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}, fill: {scale: "colour", field: "colour"}, shape: {scale: "shape", field: "shape"},
            size: {value: 80}, stroke: {value: colours.surface}, strokeWidth: {value: 1}, tooltip: {field: "title"}, cursor: {value: "pointer"}},
          hover: {size: {value: 150}}}},
      ],
    },
  };
}

export function costScatter(context) {
  return new Chart({title: "Error against cost", height: 400, onClick: (datum) => context.openIndex(datum.index),
    makeSpec: (width, colours) => scatterSpec(context.view(), context.question(), context.cost(), colours)});
}

// --- Lines

// points: [{x, y, low, high, colour, index, title}]; x as text is a category.
function linesSpec(points, {xTitle, yTitle, colourTitle, xValues, colourValues, categories}, colours) {
  if (points.length < 2 || xValues.length < 2) return null;
  const x = categories ? {name: "x", type: "point", domain: xValues, range: "width", padding: 0.3}
    : {name: "x", type: "linear", zero: false, padding: 8, domain: {data: "points", field: "x"}, range: "width"};
  return {spec: {
    data: [{name: "points", values: points}],
    scales: [x, {name: "y", ...scaleFor(points.flatMap((p) => [p.low, p.high])), range: "height"},
      colourScale("colour", colours, colourValues)],
    axes: [categories ? {scale: "x", orient: "bottom", title: xTitle, grid: false} : {...numberAxis("x", "bottom", xTitle), grid: false},
      numberAxis("y", "left", yTitle)],
    legends: colourValues.length > 1 ? [legend("colour", colourTitle)] : [],
    marks: [
      {type: "group", from: {facet: {name: "series", data: "points", groupby: "colour"}}, marks: [
        {type: "line", from: {data: "series"}, interactive: false, encode: {update: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
          stroke: {scale: "colour", field: "colour"}, strokeWidth: {value: 2}}}}]},
      bars("points", false, colours.quiet),
      {type: "symbol", from: {data: "points"}, encode: {update: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"},
        fill: {scale: "colour", field: "colour"}, size: {value: 45}, tooltip: {field: "title"}, cursor: {value: "pointer"}}, hover: {size: {value: 110}}}},
    ],
  }};
}

// Where an axis stands while another varies: where most techniques have it (suites that vary one axis at a time), or else
// at its largest number or first value.
function standing(view, axis) {
  const common = axis.values.find((value) => 2 * view.sequences.filter((s) => s.technique[axis.name] === value).length > view.sequences.length);
  return common ?? (isNumeric(axis.values) ? axis.values.at(-1) : axis.values[0]);
}

function standingSequences(view, free) {
  const fixed = view.axes.filter((axis) => !free.includes(axis.name));
  return {
    sequences: view.sequences.filter((s) => fixed.every((axis) => s.technique[axis.name] === standing(view, axis))),
    note: fixed.length ? `At ${fixed.map((axis) => `${axis.name}=${standing(view, axis)}`).join(", ")}.` : "",
  };
}

const tooltip = (label, question, y) => `${label}\n${metricTitle(question)} ${significant(y)}`;

function axisSpec(view, axis, question, colours) {
  const other = view.axes[(view.axes.indexOf(axis) + 1) % view.axes.length];
  const colourAxis = other === axis ? null : other;
  const {sequences, note} = standingSequences(view, [axis.name, colourAxis?.name]);
  const points = sequences.map((s) => {
    const y = meanError(s, question), [low, high] = meanInterval(s, question) ?? [y, y];
    return {x: s.technique[axis.name], y, low, high, colour: colourAxis ? s.technique[colourAxis.name] : "–", index: s.cells.at(-1).index, title: tooltip(s.label, question, y)};
  }).filter((p) => Number.isFinite(p.y)).sort((a, b) => axis.values.indexOf(a.x) - axis.values.indexOf(b.x));
  const made = linesSpec(points, {xTitle: axis.name, yTitle: metricTitle(question), colourTitle: colourAxis?.name, xValues: axis.values,
    colourValues: colourAxis?.values ?? ["–"], categories: true}, colours);
  return made && {...made, note};
}

export function axisChart(context, axis) {
  return new Chart({title: `Error against ${axis.name}`, height: 270, onClick: (datum) => context.openIndex(datum.index),
    makeSpec: (width, colours) => axisSpec(context.view(), axis, context.question(), colours)});
}

// The axis whose values differ most over time, if there is one: how often captures are renewed.
const timeAxis = (view) => view.axes.find((axis) => axis.name === "refresh") ?? view.axes[0];

function timeSpec(view, question, colours, valueOf, yTitle) {
  const axis = timeAxis(view);
  const {sequences, note} = standingSequences(view, [axis?.name]);
  const points = sequences.flatMap((s) => s.cells.map((cell) => {
    const y = valueOf(cell), [low, high] = yTitle ? [y, y] : intervalOf(cell, question) ?? [y, y];
    return {x: cell.frame, y, low, high, colour: axis ? s.technique[axis.name] : "–", index: cell.index, title: `frame ${cell.frame}, ${s.label}\n${yTitle ?? metricTitle(question)} ${significant(y)}`};
  })).filter((p) => Number.isFinite(p.y));
  const made = linesSpec(points, {xTitle: "frame", yTitle: yTitle ?? metricTitle(question), colourTitle: axis?.name, xValues: view.frames,
    colourValues: axis?.values ?? ["–"], categories: false}, colours);
  return made && {...made, note};
}

export function timeCharts(context) {
  const onClick = (datum) => context.openIndex(datum.index);
  const error = new Chart({title: "Error over time", height: 270, onClick,
    makeSpec: (width, colours) => timeSpec(context.view(), context.question(), colours, (cell) => errorOf(cell, context.question()))});
  const flicker = new Chart({title: "Flicker over time: change that only one renderer shows", height: 270, onClick, makeSpec: (width, colours) =>
    timeSpec(context.view(), context.question(), colours, (cell) => cell.flicker?.[context.question().region] ?? NaN, "flicker")});
  const stale = new Chart({title: "Error against staleness", height: 270, onClick, makeSpec: (width, colours) => stalenessSpec(context.view(), context.question(), colours)});
  return [error, flicker, stale];
}

function stalenessSpec(view, question, colours) {
  const axis = timeAxis(view);
  const points = view.sequences.flatMap((s) => s.cells.map((cell) => ({x: faceAgeOf(cell), y: errorOf(cell, question), colour: axis ? s.technique[axis.name] : "–",
    index: cell.index, title: tooltip(`frame ${cell.frame}, ${s.label}`, question, errorOf(cell, question))}))).filter((p) => Number.isFinite(p.x) && Number.isFinite(p.y));
  if (new Set(points.map((p) => p.x)).size < 2) return null;
  return {spec: {
    data: [{name: "points", values: points}],
    scales: [{name: "x", type: "linear", zero: true, padding: 8, domain: {data: "points", field: "x"}, range: "width"},
      {name: "y", ...scaleFor(points.map((p) => p.y)), range: "height"}, colourScale("colour", colours, axis?.values ?? ["–"])],
    axes: [{...numberAxis("x", "bottom", "mean age of the cube faces, frames")}, numberAxis("y", "left", metricTitle(question))],
    legends: axis ? [legend("colour", axis.name)] : [],
    marks: [{type: "symbol", from: {data: "points"}, encode: {update: {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}, fill: {scale: "colour", field: "colour"},
      fillOpacity: {value: 0.8}, size: {value: 45}, tooltip: {field: "title"}, cursor: {value: "pointer"}}}}],
  }, note: "Every measured frame of every technique."};
}

export const costNamed = (key) => COSTS.find((cost) => cost.key === key);
