// The style sheet of the element. Colours follow the color-scheme of the page; custom properties
// that begin with --corniche- override them.

const css = `
:host {
  display: block; position: relative; overflow: hidden; isolation: isolate; block-size: 24rem; min-block-size: 10rem;
  --surface: var(--corniche-surface, light-dark(rgb(255 255 255 / 92%), rgb(24 28 33 / 92%)));
  --ground: var(--corniche-ground, light-dark(#e8ebe6, #20262b));
  --text: var(--corniche-text, light-dark(#1c2228, #e9edf0));
  --quiet: var(--corniche-quiet, light-dark(#4d5761, #b3bdc6));
  --line: var(--corniche-line, light-dark(rgb(28 34 40 / 16%), rgb(255 255 255 / 18%)));
  --hover: var(--corniche-hover, light-dark(rgb(28 34 40 / 8%), rgb(255 255 255 / 10%)));
  --accent: var(--corniche-accent, light-dark(#0b5a86, #7cc3ee));
  --on-accent: var(--corniche-on-accent, light-dark(#fff, #0b1a24));
  --alarm: var(--corniche-alarm, light-dark(#a3271b, #ff9d8f));
  --shadow: 0 1px 2px rgb(0 0 0 / 18%), 0 4px 16px rgb(0 0 0 / 14%);
  --round: 10px;
  --touch: 2.25rem;
  --row: 1.75rem;
  color: var(--text);
  font: 0.875rem/1.4 var(--corniche-font, system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif);
}
:host([theme="light"]) { color-scheme: light; }
:host([theme="dark"]) { color-scheme: dark; }
:host([hidden]) { display: none; }
*, ::before, ::after { box-sizing: border-box; }
[hidden] { display: none !important; }
.root, .cross, .over, .opening-text, .hint, .failed, .still { position: absolute; inset: 0; }
.cross, .over, .opening-text, .hint { pointer-events: none; }
.root { container: map / size; background: var(--ground); }
canvas { display: block; inline-size: 100%; block-size: 100%; touch-action: none; outline: none; -webkit-user-select: none; user-select: none; -webkit-touch-callout: none; cursor: grab; }
.cooperative canvas { touch-action: pan-x pan-y; }
.cooperative :is(dt, dd).greedy, .root:not(.cooperative) :is(dt, dd).cooperative { display: none; }
canvas:active { cursor: grabbing; }
canvas:focus-visible { outline: 3px solid var(--accent); outline-offset: -3px; }
.cross { margin: auto; inline-size: 22px; block-size: 22px; display: none; fill: none; stroke: var(--accent); stroke-width: 2; filter: drop-shadow(0 0 1px #fff); }
canvas:focus-visible ~ .cross { display: block; }

.over {
  padding: 0.625rem; display: grid; gap: 0.5rem;
  grid-template: "stack middle panel" minmax(0, 1fr) "bar bar bar" auto / auto minmax(0, 1fr) auto;
}
.over > *, .middle > *, .bar > * { pointer-events: auto; }
.middle { grid-area: middle; display: flex; flex-direction: column; justify-content: space-between; align-items: flex-start; gap: 0.5rem; min-block-size: 0; pointer-events: none !important; }
.stack { grid-area: stack; display: flex; flex-direction: column; gap: 0.5rem; align-self: start; }
.bar { grid-area: bar; display: flex; gap: 0.5rem; align-items: flex-end; justify-content: space-between; pointer-events: none !important; }
.card { background: var(--surface); border-radius: var(--round); box-shadow: var(--shadow); color: var(--text); }
@supports (backdrop-filter: blur(1px)) { .card { backdrop-filter: blur(14px) saturate(1.3); } }
.scroll { overflow: auto; overscroll-behavior: contain; min-block-size: 0; scrollbar-width: thin; }
.scroll:focus-visible { outline: 2px solid var(--accent); outline-offset: -2px; border-radius: 6px; }

button, select, input[type="text"] { font: inherit; color: inherit; min-block-size: var(--touch); border-radius: 7px; }
button { display: inline-flex; align-items: center; justify-content: center; gap: 0.45rem; border: 0; background: none; padding: 0 0.7rem; cursor: pointer; }
button:hover { background: var(--hover); }
button:focus-visible, select:focus-visible, input:focus-visible, summary:focus-visible, a:focus-visible { outline: 2px solid var(--accent); outline-offset: 1px; }
button[aria-pressed="true"] { background: var(--accent); color: var(--on-accent); }
button.plain { border: 1px solid var(--line); }
button.icon { padding: 0; inline-size: var(--touch); flex: none; }
svg { inline-size: 1.25rem; block-size: 1.25rem; flex: none; fill: none; stroke: currentColor; stroke-width: 1.75; stroke-linecap: round; stroke-linejoin: round; }
.group { display: flex; flex-direction: column; overflow: hidden; }
.group button { inline-size: var(--tool, 2.5rem); block-size: var(--tool, 2.5rem); padding: 0; border-radius: 0; }
.group button + button { border-block-start: 1px solid var(--line); }
.group button:focus-visible { outline-offset: -3px; border-radius: var(--round); }
.compass .needle { inline-size: 1.75rem; block-size: 1.75rem; stroke: none; }
.compass .needle path:first-child { fill: #d0392b; }
.compass .needle path:last-child { fill: light-dark(#8a949d, #cfd6dc); }

.panel { grid-area: panel; inline-size: 19rem; display: flex; flex-direction: column; align-self: start; max-block-size: 100%; min-block-size: 0; }
.panel > .scroll { padding-block-end: 0.4rem; }
header { display: flex; align-items: center; justify-content: space-between; gap: 0.5rem; padding: 0.35rem 0.35rem 0.35rem 0.9rem; }
h2 { font-size: 1rem; font-weight: 650; margin: 0; overflow-wrap: anywhere; }
h3 { font-size: 0.8125rem; font-weight: 600; margin: 0.4rem 0 0; }
details { border-block-start: 1px solid var(--line); }
summary { display: flex; align-items: center; min-block-size: var(--touch); padding-inline: 0.9rem; font-weight: 600; cursor: pointer; list-style: none; justify-content: space-between; }
summary::-webkit-details-marker { display: none; }
summary::after { content: ""; inline-size: 0.4rem; block-size: 0.4rem; border: solid var(--quiet); border-width: 0 1.75px 1.75px 0; rotate: 45deg; translate: 0 -2px; }
details[open] > summary::after { rotate: 225deg; translate: 0 2px; }
summary:focus-visible { outline-offset: -3px; }
.inside { display: grid; gap: 0.6rem; padding: 0 0.9rem 0.8rem; }
.legend { list-style: none; margin: 0; padding: 0; }
.check, .named-class { display: flex; align-items: center; gap: 0.55rem; min-block-size: var(--row); }
.check { cursor: pointer; }
input[type="checkbox"] { inline-size: 1.05rem; block-size: 1.05rem; margin: 0; accent-color: var(--accent); flex: none; }
.swatch { inline-size: 1.5rem; block-size: 0.45rem; border-radius: 3px; flex: none; box-shadow: 0 0 0 1px light-dark(rgb(0 0 0 / 45%), rgb(255 255 255 / 45%)); }
.legend .legend { margin-inline-start: 1.6rem; }
.point-swatch { border-radius: 50%; inline-size: 0.6rem; block-size: 0.6rem; }
.line-swatch { inline-size: 1.5rem; border-block-start: 2px dashed currentColor; flex: none; }
.choice { border: 0; margin: 0; padding: 0; min-inline-size: 0; }
.choice legend, .field label { color: var(--quiet); padding: 0; }
.row { display: flex; border: 1px solid var(--line); border-radius: 8px; overflow: hidden; margin-block-start: 0.25rem; }
.row label { flex: 1 1 auto; position: relative; }
.row label + label { border-inline-start: 1px solid var(--line); }
.row input { position: absolute; inset: 0; margin: 0; opacity: 0; inline-size: 100%; block-size: 100%; cursor: pointer; }
.row span { display: grid; place-items: center; min-block-size: calc(var(--touch) - 4px); padding-inline: 0.4rem; }
.row input:hover + span { background: var(--hover); }
.row input:checked + span { background: var(--accent); color: var(--on-accent); }
.row input:focus-visible + span { outline: 2px solid var(--accent); outline-offset: -4px; border-radius: 8px; }
.row input:checked:focus-visible + span { outline-color: var(--on-accent); }
.field { display: grid; grid-template-columns: 1fr auto; align-items: center; gap: 0.1rem 0.6rem; }
.field output { font-variant-numeric: tabular-nums; }
.field input[type="range"] { grid-column: 1 / -1; inline-size: 100%; margin: 0; min-block-size: 1.5rem; accent-color: var(--accent); }
select, input[type="text"] { border: 1px solid var(--line); background: light-dark(rgb(255 255 255 / 70%), rgb(0 0 0 / 25%)); padding-inline: 0.6rem; min-inline-size: 0; }
option { background: light-dark(#fff, #22282e); }
.go-to { display: grid; grid-template-columns: 1fr auto; gap: 0.4rem; }
.go-to input[aria-invalid="true"] { border-color: var(--alarm); }
.wrong { grid-column: 1 / -1; margin: 0; color: var(--alarm); }
.wrong:empty { display: none; }
.actions { display: grid; grid-template-columns: 1fr 1fr; gap: 0.4rem; }
.action { justify-content: flex-start; border: 1px solid var(--line); padding-inline: 0.5rem; gap: 0.4rem; text-align: start; line-height: 1.15; font-size: 0.8125rem; }
.record svg { color: var(--alarm); fill: currentColor; }
.record[aria-pressed="true"] { background: var(--alarm); color: light-dark(#fff, #2a0d09); }
.record[aria-pressed="true"] svg { color: inherit; }
dl { display: grid; grid-template-columns: minmax(5rem, auto) 1fr; gap: 0.3rem 0.9rem; margin: 0; }
dt { color: var(--quiet); }
dd { margin: 0; overflow-wrap: anywhere; }

.notices { display: flex; flex-direction: column; gap: 0.4rem; align-items: flex-start; inline-size: 100%; pointer-events: none !important; }
.notice { display: flex; align-items: center; gap: 0.3rem; padding-inline-start: 0.8rem; max-inline-size: 28rem; pointer-events: auto; overflow-wrap: anywhere; }
.notice span { padding-block: 0.4rem; }
.notice.warn { box-shadow: var(--shadow), inset 3px 0 var(--alarm); }
.place-card { inline-size: 17rem; max-inline-size: 100%; max-block-size: 60%; display: flex; flex-direction: column; }
.place-card .scroll { padding: 0 0.9rem 0.8rem; }

.pill { background: var(--surface); border-radius: 6px; padding: 0.15rem 0.5rem; font-size: 0.75rem; box-shadow: 0 1px 3px rgb(0 0 0 / 20%); }
.facts { display: flex; gap: 0.5rem; align-items: flex-end; min-inline-size: 0; flex-wrap: wrap; }
.scale { text-align: start; }
.scale .bar { display: block; block-size: 0.3rem; border: solid currentColor; border-width: 0 1.5px 1.5px; }
.status { display: flex; flex-wrap: wrap; gap: 0 0.9rem; font-variant-numeric: tabular-nums; white-space: pre-wrap; }
.status:not(:has(span:not(:empty))) { display: none; }
.status span:empty { display: none; }
.credit { text-align: end; margin-inline-start: auto; max-inline-size: 60%; text-wrap: balance; }
.credit a { color: inherit; }
.progress { position: absolute; inset: 0 0 auto; block-size: 3px; pointer-events: none; opacity: 1; transition: opacity 0.4s 0.2s; }
.progress[aria-hidden="true"] { opacity: 0; }
.progress div { block-size: 100%; inline-size: 0; background: var(--accent); transition: inline-size 0.2s; }
.progress.opening div { inline-size: 30%; animation: opening 1.4s ease-in-out infinite alternate; }
@keyframes opening { to { margin-inline-start: 70%; } }
.opening-text, .hint, .failed { display: grid; place-items: center; }
.opening-text { color: var(--quiet); }
.hint { padding: 1rem; opacity: 0; transition: opacity 0.25s; background: rgb(0 0 0 / 30%); }
.hint.shown { opacity: 1; }
.hint .card { padding: 0.6rem 1rem; font-size: 1rem; text-align: center; text-wrap: balance; }
.hint .card:empty { display: none; }

.divider { position: absolute; inset-block: 0; inline-size: 24px; margin-inline-start: -12px; cursor: ew-resize; touch-action: none; outline: none; }
.divider::before { content: ""; position: absolute; inset: 0 auto 0 11px; inline-size: 2px; background: #fff; box-shadow: 0 0 0 1px rgb(0 0 0 / 45%); }
.divider::after { content: ""; position: absolute; inset-block-start: calc(50% - 14px); inset-inline-start: 4px; inline-size: 16px; block-size: 28px; border-radius: 8px; background: var(--surface); box-shadow: var(--shadow); }
.divider:focus-visible::after { outline: 3px solid var(--accent); }
.divider span { position: absolute; inset-block-end: 3.2rem; background: var(--surface); padding: 0 0.4rem; border-radius: 5px; font-size: 0.75rem; }
.divider span:first-child { right: 20px; }
.divider span:last-child { left: 20px; }

dialog { border: 0; padding: 0; inline-size: min(36rem, calc(100vw - 2rem)); max-block-size: min(46rem, calc(100dvh - 2rem)); color: inherit; overflow: hidden; }
dialog[open] { display: flex; flex-direction: column; }
dialog.card { background: light-dark(#fff, #1b2025); }
dialog::backdrop { background: rgb(0 0 0 / 40%); }
dialog dl { overflow: auto; padding: 0.2rem 0.9rem 1rem; grid-template-columns: minmax(7rem, 34%) 1fr; gap: 0.5rem 1rem; }
dialog dl:focus-visible { outline: 2px solid var(--accent); outline-offset: -3px; }
dialog dt { color: inherit; font-weight: 600; }

.failed { padding: 1rem; overflow: auto; background: var(--ground); }
.failure { position: relative; padding: 1.1rem 1.3rem 1.3rem; max-inline-size: 30rem; overflow-wrap: anywhere; }
.failure h2 { display: flex; gap: 0.6rem; align-items: center; font-size: 1.125rem; }
.failure h2 svg { color: var(--alarm); inline-size: 1.5rem; block-size: 1.5rem; }
.failure p { margin: 0.6rem 0 0; }
.failure .address { color: var(--quiet); font-size: 0.8125rem; }
.failure button { margin-block-start: 1rem; }
.still { inline-size: 100%; block-size: 100%; object-fit: cover; }
.still-credit { position: absolute; inset-block-end: 0.625rem; inset-inline-end: 0.625rem; margin: 0; }
.still[hidden] + .still-credit { display: none; }
.failed:has(.still:not([hidden])) { align-items: end; padding-block-end: 2.6rem; }

@media (pointer: coarse) { :host { --touch: 44px; --row: 44px; --tool: 44px; } .field input[type="range"] { min-block-size: 44px; } }
@container map (width <= 560px) {
  .over { grid-template: "middle stack" minmax(0, 1fr) "bar bar" auto "panel panel" fit-content(62%) / minmax(0, 1fr) auto; padding: 0.5rem; }
  .panel { inline-size: auto; align-self: stretch; margin: 0 -0.5rem -0.5rem; border-end-start-radius: 0; border-end-end-radius: 0; padding-block-end: env(safe-area-inset-bottom); max-block-size: 58cqh; }
  .over:has(.panel:not([hidden])) .place-card, .over:has(.panel:not([hidden])) .help-button { display: none; }
  .status .camera { display: none; }
  .facts { flex: none; }
  .credit { max-inline-size: none; }
  .place-card { inline-size: 100%; }
}
@container map (width <= 560px) or (height <= 340px) { .status { display: none; } }
@container map (height <= 340px) { .stack { flex-direction: row; align-items: flex-start; } .help-button { display: none; } }
@container map (width <= 560px) and (height <= 500px) { .over:has(.panel:not([hidden])) :is(.stack, .middle) { display: none; } }
@media (prefers-reduced-motion: reduce) { *, ::before, ::after { transition: none !important; animation: none !important; } }
@media (forced-colors: active) { .row input:checked + span, button[aria-pressed="true"] { outline: 2px solid Highlight; outline-offset: -3px; } .card, .pill { border: 1px solid; } }
`;

/** @type {CSSStyleSheet | null} */
let sheet = null;

/** One style sheet for all maps of a page. */
export function look() {
  if (!sheet) {
    sheet = new CSSStyleSheet();
    sheet.replaceSync(css);
  }
  return sheet;
}
