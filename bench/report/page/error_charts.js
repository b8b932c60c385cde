// Charts of errors: against each axis of the technique, over time and against staleness.
import {Chart, numberAxis, scaleFor} from "./chart.js";
import {bars, colourScale, legend, line, metricTitle, symbols} from "./chart_parts.js";
import {errorOf, faceAgeOf, intervalOf, meanError, meanInterval} from "./model.js";
import {significant} from "./numbers.js";

const isNumeric = (values) => values.every((v) => v !== "" && Number.isFinite(Number(v)));

// --- Lines

// points: [{x, y, low, high, colour, index, title}]; x as text is a category.
function linesSpec(points, {xTitle, yTitle, colourTitle, xValues, colourValues, categories, note}, colours) {
  if (points.length < 2 || xValues.length < 2) return null;
  const x = categories
    ? {name: "x", type: "point", domain: xValues, range: "width", padding: 0.3}
    : {name: "x", type: "linear", zero: false, padding: 8, domain: {data: "points", field: "x"}, range: "width"};
  return {
    note,
    spec: {
      data: [{name: "points", values: points}],
      scales: [
        x,
        {name: "y", ...scaleFor(points.flatMap((p) => [p.low, p.high])), range: "height"},
        colourScale("colour", colours, colourValues),
      ],
      axes: [
        categories
          ? {scale: "x", orient: "bottom", title: xTitle, grid: false}
          : {...numberAxis("x", "bottom", xTitle), grid: false},
        numberAxis("y", "left", yTitle),
      ],
      legends: colourValues.length > 1 ? [legend("colour", colourTitle)] : [],
      marks: [
        {
          type: "group",
          from: {facet: {name: "series", data: "points", groupby: "colour"}},
          marks: [line("series", {stroke: {scale: "colour", field: "colour"}, strokeWidth: {value: 2}})],
        },
        bars("points", false, colours.quiet),
        symbols(45),
      ],
    },
  };
}

// Where an axis stands while another varies: where most techniques have it (suites that vary one axis at a time), or else
// at its largest number or first value.
function standing(view, axis) {
  const common = axis.values.find(
    (value) => 2 * view.sequences.filter((s) => s.technique[axis.name] === value).length > view.sequences.length,
  );
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
  const points = sequences
    .map((s) => {
      const y = meanError(s, question),
        [low, high] = meanInterval(s, question) ?? [y, y];
      return {
        x: s.technique[axis.name],
        y,
        low,
        high,
        colour: colourAxis ? s.technique[colourAxis.name] : "–",
        index: s.cells.at(-1).index,
        title: tooltip(s.label, question, y),
      };
    })
    .filter((p) => Number.isFinite(p.y))
    .sort((a, b) => axis.values.indexOf(a.x) - axis.values.indexOf(b.x));
  return linesSpec(
    points,
    {
      xTitle: axis.name,
      yTitle: metricTitle(question),
      colourTitle: colourAxis?.name,
      xValues: axis.values,
      colourValues: colourAxis?.values ?? ["–"],
      categories: true,
      note,
    },
    colours,
  );
}

export function axisChart(context, axis) {
  return new Chart({
    title: `Error against ${axis.name}`,
    height: 270,
    onClick: (datum) => context.openIndex(datum.index),
    makeSpec: (width, colours) => axisSpec(context.view(), axis, context.question(), colours),
  });
}

// The axis whose values differ most over time, if there is one: how often captures are renewed.
const timeAxis = (view) => view.axes.find((axis) => axis.name === "refresh") ?? view.axes[0];

function timeSpec(view, question, colours, valueOf, yTitle) {
  const axis = timeAxis(view);
  const {sequences, note} = standingSequences(view, [axis?.name]);
  const points = sequences
    .flatMap((s) =>
      s.cells.map((cell) => {
        const y = valueOf(cell),
          [low, high] = yTitle ? [y, y] : (intervalOf(cell, question) ?? [y, y]);
        return {
          x: cell.frame,
          y,
          low,
          high,
          colour: axis ? s.technique[axis.name] : "–",
          index: cell.index,
          title: `frame ${cell.frame}, ${s.label}\n${yTitle ?? metricTitle(question)} ${significant(y)}`,
        };
      }),
    )
    .filter((p) => Number.isFinite(p.y));
  return linesSpec(
    points,
    {
      xTitle: "frame",
      yTitle: yTitle ?? metricTitle(question),
      colourTitle: axis?.name,
      xValues: view.frames,
      colourValues: axis?.values ?? ["–"],
      categories: false,
      note,
    },
    colours,
  );
}

export function timeCharts(context) {
  const onClick = (datum) => context.openIndex(datum.index);
  const error = new Chart({
    title: "Error over time",
    height: 270,
    onClick,
    makeSpec: (width, colours) =>
      timeSpec(context.view(), context.question(), colours, (cell) => errorOf(cell, context.question())),
  });
  const flicker = new Chart({
    title: "Flicker over time: change that only one renderer shows",
    height: 270,
    onClick,
    makeSpec: (width, colours) =>
      timeSpec(
        context.view(),
        context.question(),
        colours,
        (cell) => cell.flicker?.[context.question().region] ?? NaN,
        "flicker",
      ),
  });
  const stale = new Chart({
    title: "Error against staleness",
    height: 270,
    onClick,
    makeSpec: (width, colours) => stalenessSpec(context.view(), context.question(), colours),
  });
  return [error, flicker, stale];
}

function stalenessSpec(view, question, colours) {
  const axis = timeAxis(view);
  const points = view.sequences
    .flatMap((s) =>
      s.cells.map((cell) => ({
        x: faceAgeOf(cell),
        y: errorOf(cell, question),
        colour: axis ? s.technique[axis.name] : "–",
        index: cell.index,
        title: tooltip(`frame ${cell.frame}, ${s.label}`, question, errorOf(cell, question)),
      })),
    )
    .filter((p) => Number.isFinite(p.x) && Number.isFinite(p.y));
  if (new Set(points.map((p) => p.x)).size < 2) return null;
  return {
    spec: {
      data: [{name: "points", values: points}],
      scales: [
        {name: "x", type: "linear", zero: true, padding: 8, domain: {data: "points", field: "x"}, range: "width"},
        {name: "y", ...scaleFor(points.map((p) => p.y)), range: "height"},
        colourScale("colour", colours, axis?.values ?? ["–"]),
      ],
      axes: [
        {...numberAxis("x", "bottom", "mean age of the cube faces, frames")},
        numberAxis("y", "left", metricTitle(question)),
      ],
      legends: axis ? [legend("colour", axis.name)] : [],
      marks: [symbols(45, {fillOpacity: {value: 0.8}})],
    },
    note: "Every measured frame of every technique.",
  };
}
