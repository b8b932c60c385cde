// Choices that are worth their cost; the rule of bench/pareto.h. A choice is {sequence, error, cost,
// isNoiseKnown}, error and cost {value, low, high}, less is better.

const isBelow = (a, b) => a.high < b.low;

// Whether the error of a is smaller than that of b for sure: as the program found it where there is noise, which the two
// have in common; without noise by their values. Nothing is sure where the noise is not known: of the truth with as many
// bounces, and of metrics without intervals.
function orderOf(choices, {metric, region, truth}) {
  const orders = choices[0]?.sequence.view.orders ?? [];
  const first = choices[0]?.sequence.cells[0].index;
  const order =
    truth === "converged" && orders.find((o) => o.metric === metric && o.region === region && o.cells.includes(first));
  if (!order) return (a, b) => a.isNoiseKnown && b.isNoiseKnown && isBelow(a.error, b.error);
  const place = new Map(order.cells.map((index, i) => [index, i]));
  const placeOf = (choice) => place.get(choice.sequence.cells[0].index);
  return (a, b) => order.better[placeOf(a)]?.[placeOf(b)] === "1";
}

export function paretoFront(choices, question) {
  const isBetter = orderOf(choices, question);
  // Differences that may be chance dominate nothing.
  const dominates = (a, b) =>
    a.error.value <= b.error.value && a.cost.value <= b.cost.value && (isBetter(a, b) || isBelow(a.cost, b.cost));
  return choices
    .filter((choice) => !choices.some((other) => dominates(other, choice)))
    .sort((a, b) => a.cost.value - b.cost.value || a.error.value - b.error.value);
}
