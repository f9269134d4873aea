// The extent of a run, set by scripts/test: some cases if CORNICHE_TIER is `ci`, otherwise all.

/** Every `step`-th case in CI, and all cases otherwise. CORNICHE_TURN, a number, selects the first one, so that the cases alternate by day. */
export function someOf(cases, step) {
  if (process.env.CORNICHE_TIER !== "ci") return cases;
  const turn = Number(process.env.CORNICHE_TURN ?? 0) % step;
  return cases.filter((_, index) => index % step === turn);
}
