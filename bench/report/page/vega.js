// Vega from the modules that Debian packages: each is a CommonJS module in `vegaSources`, loaded when another wants it.

const OTHER_NAMES = {"vega-selections": "vega-selection"}; // as vega-functions calls it
const loadedModules = {};

function requireVega(name) {
  const known = OTHER_NAMES[name] ?? name;
  if (!(known in loadedModules)) {
    const module = {exports: {}};
    loadedModules[known] = module.exports;
    globalThis.vegaSources[known](module.exports, module, requireVega);
  }
  return loadedModules[known];
}

let vegaParts = null;

// Draws a specification into a node. Expressions are interpreted, not compiled: the page evaluates no text as code.
export function drawVega(node, specification, onClick) {
  if (!vegaParts) {
    const {transforms} = requireVega("vega-dataflow");
    for (const name of ["vega-transforms", "vega-view-transforms", "vega-encode"])
      Object.assign(transforms, requireVega(name));
    vegaParts = {
      parse: requireVega("vega-parser").parse,
      View: requireVega("vega-view").View,
      expr: requireVega("vega-interpreter").expressionInterpreter,
    };
  }
  const runtime = vegaParts.parse(specification, {}, {ast: true});
  const view = new vegaParts.View(runtime, {expr: vegaParts.expr, renderer: "svg", logLevel: 1});
  view.initialize(node).hover();
  if (onClick) view.addEventListener("click", (event, item) => item?.datum && onClick(item.datum));
  view.run();
  return view;
}
