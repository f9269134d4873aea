// The packages next to the page: packages.json, written by `corniche serve`.

/** A list of { name, src, layers }, with absolute addresses; empty if there is no list. */
export async function packages() {
  const address = new URL("packages.json", import.meta.url);
  const answer = await fetch(address).catch(() => null);
  if (!answer?.ok) return [];
  const list = await answer.json().catch(() => []);
  return list.map(({ src, ...rest }) => ({ ...rest, src: new URL(src, address).href }));
}
