// Choices that are worth their cost; the rule of bench/pareto.h. A choice is {error, cost}, each {value, low, high}, less is better.

const isBelow = (a, b) => a.high < b.low;

// Differences that may be chance dominate nothing.
function dominates(a, b) {
  const noWorse = a.error.value <= b.error.value && a.cost.value <= b.cost.value;
  return noWorse && (isBelow(a.error, b.error) || isBelow(a.cost, b.cost));
}

export function paretoFront(choices) {
  return choices
    .filter((choice) => !choices.some((other) => dominates(other, choice)))
    .sort((a, b) => a.cost.value - b.cost.value || a.error.value - b.error.value);
}
