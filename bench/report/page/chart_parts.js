// What several charts have in common.
import {METRICS} from "./model.js";

export const metricTitle = ({metric, region, truth}) =>
  `${METRICS.find((m) => m.key === metric).title}, ${region === "mask" ? "mask" : "whole image"}${truth === "matched" ? ", own bounces" : ""}`;

export function legend(name, title) {
  return {fill: name, title, orient: "bottom", direction: "horizontal", columns: 4, offset: 6};
}

export const colourScale = (name, colours, values) => ({name, type: "ordinal", domain: values, range: colours.series});

const PLACE = {x: {scale: "x", field: "x"}, y: {scale: "y", field: "y"}};

// A line through the rows of `data`; `style` holds further channels.
export const line = (data, style) => ({
  type: "line",
  from: {data},
  interactive: false,
  encode: {update: {...PLACE, ...style}},
});

// The rows of "points" as symbols that open their cell, larger when pointed at; `style` holds further channels.
export const symbols = (size, style = {}) => ({
  type: "symbol",
  from: {data: "points"},
  encode: {
    update: {
      ...PLACE,
      fill: {scale: "colour", field: "colour"},
      size: {value: size},
      tooltip: {field: "title"},
      cursor: {value: "pointer"},
      ...style,
    },
    hover: {size: {value: 2 * size}},
  },
});

// Intervals as rules: of the cost along x, of the error along y.
export function bars(data, horizontal, colour) {
  const along = horizontal
    ? {x: {scale: "x", field: "xLow"}, x2: {scale: "x", field: "xHigh"}, y: {scale: "y", field: "y"}}
    : {y: {scale: "y", field: "low"}, y2: {scale: "y", field: "high"}, x: {scale: "x", field: "x"}};
  return {
    type: "rule",
    from: {data},
    interactive: false,
    encode: {update: {...along, stroke: {value: colour}, strokeOpacity: {value: 0.6}}},
  };
}
