#pragma once

/// The style of report.html: light, dark and print.

#include <string_view>

namespace rhexis::studies {

inline constexpr std::string_view kReportStyle = R"css(
:root { --ground: #ffffff; --text: #1f2328; --quiet: #59636e; --line: #d9dee4; --band: #f4f6f8; --accent: #1f5fa8;
  --picture: #e4e7eb; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --ground: #0d1117; --text: #e6edf3; --quiet: #9198a1; --line: #2b3138;
  --band: #161b22; --accent: #6cb0ff; --picture: #14181d; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1120px; padding: 24px 20px 60px; background: var(--ground); color: var(--text);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Liberation Sans", sans-serif; }
h1 { font-size: 24px; margin: 0 0 4px; } h2 { font-size: 18px; margin: 36px 0 8px; }
p { margin: 8px 0; max-width: 80ch; } a { color: var(--accent); }
.quiet, figcaption, caption { color: var(--quiet); } figcaption, caption { font-size: 14px; text-align: left; }
caption { padding-bottom: 6px; caption-side: top; }
code { font: 13px ui-monospace, "Liberation Mono", monospace; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; margin: 14px 0; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 12px 4px 0; border-bottom: 1px solid var(--line); vertical-align: top; text-align: left; }
th { font-weight: 600; } td.n, th.n { text-align: right; white-space: nowrap; }
tbody tr:nth-child(even) { background: var(--band); }
.published td.words { min-width: 16ch; } .published td.why { min-width: 26ch; }
figure { margin: 22px 0; } figure svg { max-width: 100%; height: auto; border: 1px solid var(--line); border-radius: 6px; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 16px; font-size: 14px; }
dt { color: var(--quiet); } dd { margin: 0; overflow-wrap: anywhere; }
details { margin: 14px 0; } summary { cursor: pointer; color: var(--accent); }
.warning { border-left: 3px solid #d55e00; padding-left: 12px; }
.shapes .turned { display: none; } .shapes.live .turned { display: block; } .shapes.live .still { display: none; }
.panels { display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: 10px; }
.panel { position: relative; } .panel canvas { width: 100%; height: 300px; display: block; border-radius: 6px;
  background: var(--picture); cursor: grab; touch-action: pan-y; } .panel canvas:focus-visible { outline: 2px solid var(--accent); }
.panel span { position: absolute; left: 10px; top: 6px; font-size: 13px; pointer-events: none; }
.legend { display: flex; align-items: center; gap: 8px; font-size: 13px; margin: 8px 0; flex-wrap: wrap; }
.legend i { display: inline-block; width: 220px; height: 12px; border-radius: 2px; print-color-adjust: exact; }
@media print {
  :root { --ground: #fff; --text: #000; --quiet: #444; --line: #bbb; --band: #fff; --picture: #fff; color-scheme: light; }
  body { max-width: none; padding: 0; font-size: 10pt; } table { font-size: 8.5pt; }
  h2 { break-after: avoid; } figure, tr { break-inside: avoid; } .scroll { overflow: visible; }
  .shapes.live .turned { display: none; } .shapes.live .still { display: block; } .turn-hint { display: none; }
  .rhexis-chart .ground, .rhexis-shapes .ground { fill: #fff !important; }
  .rhexis-chart text, .rhexis-shapes text { fill: #000 !important; }
}
)css";

}  // namespace rhexis::studies
