#include "tissue_stiffness/report/style.hpp"

namespace tissue_stiffness {

const char* const report_style = R"css(
:root { color-scheme: light dark; --ground: #f6f7f9; --card: #ffffff; --text: #1b2430; --soft: #5a6675; --edge: #dde2e9;
  --line: #1f6fb5; --band: #1f6fb533; --noise: #b0630a; --good: #1d7a46; --warn: #a25a00; --bad: #b3261e; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #12161c; --card: #1a2028; --text: #e6ebf1; --soft: #9aa7b6; --edge: #2c3540;
    --line: #6db3f2; --band: #6db3f23d; --noise: #f0a95b; --good: #63c98e; --warn: #f0b35b; --bad: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--text); font: 1rem/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 1rem; }
section { background: var(--card); border: 1px solid var(--edge); border-radius: .6rem; padding: 1rem 1.2rem; margin: 0 0 1rem; }
h1 { font-size: 1rem; font-weight: 600; color: var(--soft); margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.05rem; margin: 0 0 .6rem; }
p { margin: .3rem 0; }
.answer { margin: .5rem 0 0; }
.answer b { font-size: clamp(1.8rem, 7vw, 2.8rem); line-height: 1.15; font-weight: 650; white-space: nowrap; }
.answer .name { display: block; color: var(--soft); }
.answer .interval { white-space: nowrap; }
.soft { color: var(--soft); }
.badge { display: inline-block; border-radius: 1rem; padding: .05rem .7rem; font-size: .85rem; font-weight: 600;
  border: 1px solid currentColor; }
.good { color: var(--good); } .warn { color: var(--warn); } .bad { color: var(--bad); }
dl.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr)); gap: .8rem 1.2rem; margin: 0; }
dl.facts dt { color: var(--soft); font-size: .85rem; }
dl.facts dd { margin: 0; font-size: 1.15rem; font-weight: 600; }
dl.facts dd small { display: block; font-size: .8rem; font-weight: 400; color: var(--soft); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .35rem .9rem .35rem 0; border-bottom: 1px solid var(--edge); vertical-align: top; }
th { color: var(--soft); font-weight: 600; font-size: .85rem; }
tr:last-child td { border-bottom: 0; }
.n { text-align: right; white-space: nowrap; }
.why { min-width: 15rem; }
figure { margin: 0 0 1.2rem; } figure:last-child { margin-bottom: 0; }
figcaption { font-weight: 600; }
.legend { font-size: .85rem; font-weight: 400; color: var(--soft); display: flex; flex-wrap: wrap; gap: .1rem 1.1rem; }
.legend i { display: inline-block; width: 1.4rem; height: 0; margin-right: .4rem; vertical-align: .25em; border-top: 2px solid var(--line); }
.legend i.band { height: .8rem; border: 0; background: var(--band); vertical-align: -.1em; }
.legend i.reference { border-top: 2px dashed var(--noise); }
.legend i.skip { width: 2px; height: .8rem; border: 0; background: var(--bad); vertical-align: -.1em; }
.plot { position: relative; height: 15rem; margin: .5rem .6rem 2.6rem 3.6rem; }
.plot svg { position: absolute; inset: 0; width: 100%; height: 100%; }
.plot path { vector-effect: non-scaling-stroke; fill: none; stroke-linejoin: round; }
.plot .grid { stroke: var(--edge); stroke-width: 1; }
.plot .line { stroke: var(--line); stroke-width: 2; }
.plot .band { fill: var(--band); }
.plot .reference { stroke: var(--noise); stroke-width: 2; stroke-dasharray: 6 4; }
.plot .skip { stroke: var(--bad); stroke-width: 2; }
.plot span { position: absolute; font-size: .75rem; color: var(--soft); white-space: nowrap; font-variant-numeric: tabular-nums; }
.plot .y { right: 100%; padding-right: .4rem; transform: translateY(50%); line-height: 1; }
.plot .x { top: 100%; padding-top: .2rem; transform: translateX(-50%); }
.plot .axis { top: calc(100% + 1.3rem); right: 0; }
pre { overflow-x: auto; margin: .5rem 0 0; font: .82rem/1.45 ui-monospace, "DejaVu Sans Mono", monospace; }
summary { cursor: pointer; font-weight: 600; }
ul { margin: .3rem 0; padding-left: 1.2rem; }
@media (max-width: 30rem) {
  main { padding: .5rem; } section { padding: .8rem; } .plot { height: 12rem; margin-left: 3.2rem; }
  dl.facts { grid-template-columns: 1fr 1fr; } }
@media print { body { background: none; } section { break-inside: avoid; } }
)css";

}  // namespace tissue_stiffness
