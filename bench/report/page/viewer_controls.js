// The controls of the viewer: how to compare, exposure, zoom, and what the keys do.
import {element, freshId} from "./dom.js";

export const MODES = [
  {key: "flip", title: "Flip"},
  {key: "side", title: "Side by side"},
  {key: "split", title: "Split"},
  {key: "difference", title: "Difference"},
  {key: "error", title: "FLIP map"},
];
export const MAX_STOPS = 8;

const KEYS = [
  ["1 … 5", "flip, side by side, split, difference, FLIP map"],
  ["f or space", "flip: the other picture"],
  ["[ and ]", "exposure half a stop down, up"],
  ["+ and −", "zoom"],
  ["0", "whole picture, exposure 0"],
  [", and .", "frame before, after"],
  ["p and n", "technique before, after"],
];

export function modeControls(viewer) {
  const name = freshId("mode");
  return element(
    "fieldset",
    {class: "modes"},
    element("legend", {class: "unseen"}, "How to compare"),
    MODES.map((mode, i) =>
      element(
        "label",
        {title: `key ${i + 1}`},
        element("input", {
          type: "radio",
          name,
          value: mode.key,
          checked: mode.key === viewer.mode,
          onchange: () => viewer.setMode(mode.key),
        }),
        element("span", {}, mode.title),
      ),
    ),
  );
}

// Keeps its slider and text in the viewer.
export function exposureControls(viewer) {
  viewer.exposure = element("input", {
    type: "range",
    min: -MAX_STOPS,
    max: MAX_STOPS,
    step: 0.5,
    value: 0,
    class: "exposure",
    oninput: () => viewer.setStops(Number(viewer.exposure.value)),
  });
  viewer.exposureText = element("output", {}, "+0.0 stops");
  return element("label", {class: "choice"}, "Exposure", viewer.exposure, viewer.exposureText);
}

export function zoomControls(lens) {
  const button = (text, label, action) =>
    element("button", {type: "button", "aria-label": label, title: label, onclick: action}, text);
  return element(
    "span",
    {class: "zoom", role: "group", "aria-label": "Zoom"},
    button("−", "zoom out", () => lens.zoomBy(0.5)),
    button("fit", "whole picture", () => lens.reset()),
    button("+", "zoom in", () => lens.zoomBy(2)),
  );
}

export function keyHelp() {
  return element(
    "details",
    {class: "help"},
    element("summary", {}, "Keys"),
    element(
      "dl",
      {},
      KEYS.map(([key, meaning]) => [element("dt", {}, element("kbd", {}, key)), element("dd", {}, meaning)]),
    ),
    element(
      "p",
      {},
      "Ctrl and the wheel zoom, dragging moves, a double click zooms in. Exposure works on the radiance, not on the picture of it.",
    ),
  );
}
