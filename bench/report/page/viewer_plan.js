// What the viewer shows in each of its modes.
import {developed, difference} from "./pictures.js";

// Pictures at an exposure, each made once.
export class Developer {
  of(picture, stops) {
    if (this.stops !== stops) this.made = new Map();
    this.stops = stops;
    if (!this.made.has(picture)) this.made.set(picture, developed(picture, stops));
    return this.made.get(picture);
  }
}

const wholePicture = (label, picture) => ({label, parts: [{picture, from: 0, to: 1}]});

function splitPlan({rendered, against, againstTitle}, {divider}) {
  const parts = [
    {picture: against(), from: 0, to: divider},
    {picture: rendered(), from: divider, to: 1},
  ];
  return [{label: `${againstTitle} | rendered`, divider: true, parts}];
}

// Of a mode: (functions that develop the pictures, viewer) => [{label, parts}], one a stage.
const PLANS = {
  flip: ({rendered, against, againstTitle}, {flipped}) => [
    flipped ? wholePicture(againstTitle, against()) : wholePicture("rendered", rendered()),
  ],
  side: ({rendered, against, againstTitle}) => [
    wholePicture(againstTitle, against()),
    wholePicture("rendered", rendered()),
  ],
  split: splitPlan,
  difference: ({againstTitle}, {shown, stops}) => [
    wholePicture(`|rendered − ${againstTitle}|`, difference(shown.rendered, shown.against, stops)),
  ],
  error: ({rendered}, {shown}) => [
    shown.map
      ? wholePicture("FLIP map of rendered against reference", shown.map)
      : wholePicture("rendered (no FLIP map was kept)", rendered()),
  ],
};

export function planOf(viewer) {
  const {shown, developer, mode, stops} = viewer;
  const {againstTitle} = shown;
  const rendered = () => developer.of(shown.rendered, stops),
    against = () => developer.of(shown.against, stops);
  if (!shown.against) return [wholePicture("rendered", rendered())];
  if (!shown.rendered) return [wholePicture(againstTitle, against())];
  return PLANS[mode]({rendered, against, againstTitle}, viewer);
}
