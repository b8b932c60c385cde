// A run as the page uses it: cells grouped into views (a scene through a camera) and sequences (a technique on a view).
import {decode, mean, sortedValues} from "./numbers.js";

export const METRICS = [
  {key: "flip_hdr", title: "FLIP-HDR", better: "less"},
  {key: "flip_ldr", title: "FLIP-LDR", better: "less"},
  {key: "relmse", title: "relMSE", better: "less"},
  {key: "mse", title: "MSE", better: "less"},
  {key: "mae", title: "MAE", better: "less"},
  {key: "smape", title: "SMAPE", better: "less"},
  {key: "ssim", title: "SSIM", better: "more"},
  {key: "psnr", title: "PSNR", better: "more"},
];

export const COSTS = [
  {
    key: "ratio",
    title: "frame time, × plain",
    of: (cell) => cell.cost?.ratio,
    low: (c) => c.cost?.ratio_low,
    high: (c) => c.cost?.ratio_high,
  },
  {
    key: "frame_ms",
    title: "frame ms",
    of: (cell) => cell.cost?.frame_ms,
    low: (c) => c.cost?.frame_ms_low,
    high: (c) => c.cost?.frame_ms_high,
  },
  {key: "p99", title: "frame ms, 99th percentile", of: (cell) => cell.cost?.peaks?.p99},
  {key: "renders", title: "renders a frame", of: (cell) => cell.cost?.measured_renders_per_frame},
  {key: "mib", title: "probe MiB", of: (cell) => cell.counters?.probe_bytes / 2 ** 20},
];

export const isMoreBetter = (metric) => METRICS.find((m) => m.key === metric)?.better === "more";

// The scores that a question is about. question: {metric, region: "mask" | "whole", truth: "converged" | "matched"}.
function scoresOf(cell, {region, truth}) {
  const source = truth === "matched" ? cell.matched : cell;
  return region === "mask" ? source?.mask_metrics : source?.metrics;
}

function metricOf(scores, metric) {
  const value = scores?.[metric];
  return decode(metric.startsWith("flip_") ? value?.mean : value);
}

export const errorOf = (cell, question) => metricOf(scoresOf(cell, question), question.metric);

// 95 %, from the reference's noise; undefined where it is not known.
export function intervalOf(cell, {metric, region, truth}) {
  if (truth === "matched") return undefined;
  const interval = (region === "mask" ? cell.mask_intervals : cell.intervals)?.[metric];
  return interval?.map(decode);
}

export function floorOf(cell, {metric, region, truth}) {
  const source = truth === "matched" ? cell.matched : cell;
  return decode((region === "mask" ? source?.mask_floor : source?.floor)?.[metric]);
}

export function faceAgeOf(cell) {
  return mean((cell.face_age_frames ?? []).flat().filter((age) => age !== null));
}

// Over the frames of a sequence.
export const meanError = (sequence, question) => mean(sequence.cells.map((cell) => errorOf(cell, question)));

export function worstError(sequence, question) {
  const errors = sequence.cells.map((cell) => errorOf(cell, question)).filter((e) => !Number.isNaN(e));
  if (!errors.length) return NaN;
  return isMoreBetter(question.metric) ? Math.min(...errors) : Math.max(...errors);
}

// The smallest value that at least 95 % of the frames don't exceed, where more is better the largest that they reach.
export function p95Error(sequence, question) {
  const sign = isMoreBetter(question.metric) ? -1 : 1;
  const badness = sequence.cells
    .map((cell) => sign * errorOf(cell, question))
    .filter((e) => !Number.isNaN(e))
    .sort((a, b) => a - b);
  return badness.length ? sign * badness[Math.ceil(0.95 * badness.length - 1e-9) - 1] : NaN;
}

// Of the mean: as wide as those of the frames that have one are on average, as if they failed together. The rule of
// meanOverFrames() in bench/candidates.cpp. Undefined where none has one.
export function meanInterval(sequence, question) {
  const frames = sequence.cells
    .map((cell) => ({error: errorOf(cell, question), interval: intervalOf(cell, question)}))
    .filter(({error}) => !Number.isNaN(error));
  const known = frames.filter(({interval}) => interval);
  if (!known.length) return undefined;
  const error = mean(frames.map((f) => f.error));
  return [
    error - mean(known.map(({error: e, interval: [low]}) => e - low)),
    error + mean(known.map(({error: e, interval: [, high]}) => high - e)),
  ];
}

// Whether the reference's noise leaves nothing to ask about the error of a sequence: intervals are known, or there is
// no noise. The rule of isNoiseKnown() in bench/report_verdict.cpp.
export function isNoiseKnown(sequence, question) {
  if (meanInterval(sequence, question)) return true;
  return sequence.cells.every((cell) => {
    const source = question.truth === "matched" ? cell.matched : cell;
    const floor = Object.values((question.region === "mask" ? source?.mask_floor : source?.floor) ?? {});
    return floor.length > 0 && floor.every((value) => decode(value) === 0);
  });
}

const techniqueText = (technique) =>
  Object.entries(technique)
    .map(([axis, value]) => `${axis}=${value}`)
    .join(" ");

// As the program prints it and --only reads it.
export const keyOf = (cell) =>
  `scene=${cell.scene} camera=${cell.camera} frame=${cell.frame} ${techniqueText(cell.technique)}`;

function axesOf(sequences) {
  const axes = new Map();
  for (const {technique} of sequences)
    for (const [axis, value] of Object.entries(technique)) {
      if (!axes.has(axis)) axes.set(axis, []);
      if (!axes.get(axis).includes(value)) axes.get(axis).push(value);
    }
  return [...axes]
    .filter(([, values]) => values.length > 1)
    .map(([name, values]) => ({name, values: sortedValues(values)}));
}

function addLabels(view) {
  for (const sequence of view.sequences) {
    const named = view.axes.filter((axis) => axis.name in sequence.technique);
    sequence.label =
      named.map((axis) => `${axis.name}=${sequence.technique[axis.name]}`).join(" ") ||
      (sequence.technique.external ?? "the only technique");
    for (const cell of sequence.cells) {
      cell.sequence = sequence;
      cell.shortKey = `scene=${view.scene} camera=${view.camera} frame=${cell.frame} ${sequence.label}`;
    }
  }
}

export function makeModel(results) {
  const views = new Map();
  results.cells.forEach((cell, index) => {
    cell.index = index;
    cell.key = keyOf(cell);
    const place = JSON.stringify([cell.scene, cell.camera]);
    if (!views.has(place))
      views.set(place, {id: String(views.size), scene: cell.scene, camera: cell.camera, bySequence: new Map()});
    const sequences = views.get(place).bySequence;
    const technique = techniqueText(cell.technique);
    if (!sequences.has(technique))
      sequences.set(technique, {view: views.get(place), technique: cell.technique, cells: []});
    sequences.get(technique).cells.push(cell);
  });
  for (const view of views.values()) {
    view.sequences = [...view.bySequence.values()];
    view.axes = axesOf(view.sequences);
    view.frames = [...new Set(view.sequences.flatMap((s) => s.cells.map((c) => c.frame)))].sort((a, b) => a - b);
    view.hasMask = view.sequences.some((s) => s.cells.some((c) => c.mask_metrics));
    view.title =
      views.size > 1 && [...views.values()].filter((v) => v.scene === view.scene).length > 1
        ? `${view.scene}, camera ${view.camera}`
        : view.scene;
    addLabels(view);
  }
  return {...results, views: [...views.values()]};
}
