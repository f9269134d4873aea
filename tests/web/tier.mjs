// How much a run looks at, as scripts/test says it: some cases where CORNICHE_TIER is `ci`, else all.

/** Each `step`-th of some cases in CI, all of them otherwise. CORNICHE_TURN, a number, says with which to begin, so that other days look at others. */
export function someOf(cases, step) {
  if (process.env.CORNICHE_TIER !== "ci") return cases;
  const turn = Number(process.env.CORNICHE_TURN ?? 0) % step;
  return cases.filter((_, index) => index % step === turn);
}
