// The style sheet of the report: light, for screen and print.
#ifndef EYEBOX_SERVICE_REPORT_STYLE_H_
#define EYEBOX_SERVICE_REPORT_STYLE_H_

#include <string_view>

namespace eyebox::service::report {

inline constexpr std::string_view kStyle = R"(
:root { color-scheme: light; }
body { max-width: 54rem; margin: 2rem auto; padding: 0 1.5rem; background: #fff; color: #1a1a1a;
  font: 16px/1.5 "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; border-bottom: 1px solid #ccc; }
h3 { font-size: 1rem; margin: 1.4rem 0 .4rem; }
.keys { display: flex; flex-wrap: wrap; gap: .8rem; margin: 1.2rem 0; padding: 0; }
.key { flex: 1 1 11rem; border: 1px solid #cfd8e3; border-top: 3px solid #3b6ea5;
  padding: .5rem .8rem; background: #f7f9fc; }
.key .label, .key .note { font-size: .85rem; color: #444; }
.key .value { font-size: 1.25rem; font-weight: 600; white-space: nowrap; }
dl.facts { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1rem; margin: 0;
  font-size: .95rem; }
dl.facts dt { color: #555; }
dl.facts dd { margin: 0; overflow-wrap: anywhere; }
.warnings { border-left: 4px solid #c77700; background: #fff8ec; padding: .5rem 1rem; }
.warnings p { margin: 0; font-weight: 600; }
.warnings ul { margin: .3rem 0; padding-left: 1.2rem; }
figure { margin: 1rem 0 1.6rem; break-inside: avoid; }
figcaption { font-size: .92rem; color: #333; max-width: 44rem; }
table { border-collapse: collapse; font-size: .92rem; margin: .4rem 0 1rem; }
th { text-align: left; border-bottom: 2px solid #888; padding: .2rem 1rem .2rem 0; }
td { border-bottom: 1px solid #ddd; padding: .2rem 1rem .2rem 0; white-space: nowrap;
  font-variant-numeric: tabular-nums; }
td.numeric, th.numeric { text-align: right; }
ol.history { font: .82rem/1.5 ui-monospace, "DejaVu Sans Mono", monospace; color: #333; }
ol.history li { overflow-wrap: anywhere; }
svg { max-width: 100%; height: auto; display: block; }
svg text { fill: #1a1a1a; font-size: 13px; }
svg .number { font-size: 12px; fill: #333; }
svg .frame { fill: none; stroke: #333; stroke-width: 1; }
svg .tick { stroke: #333; stroke-width: 1; }
svg .grid { fill: none; stroke: #e4e4e4; stroke-width: 1; }
svg .zero { stroke: #888; stroke-width: 1; }
svg .curve { fill: none; stroke-width: 1.8; stroke-linejoin: round; }
svg .curve-0 { stroke: #0b62a4; }
svg .curve-1 { stroke: #d1570a; stroke-dasharray: 7 3; }
svg .curve-2 { stroke: #5a8f00; stroke-dasharray: 2 3; }
svg .curve-3 { stroke: #7b3fa0; stroke-dasharray: 9 3 2 3; }
svg .point { fill: #fff; stroke: #1a1a1a; stroke-width: 1.4; }
svg .worst { fill: none; stroke: #b00020; stroke-width: 1.6; }
svg .error-bar { stroke: #1a1a1a; stroke-width: 1.2; }
svg .certified { fill: #eef4fa; }
svg .contour { fill: none; stroke: #fff; stroke-width: 1.3; }
svg .contour-label { font-size: 12px; font-weight: 600; fill: #fff; stroke: #222;
  stroke-width: 2.4px; paint-order: stroke; }
footer { margin-top: 2.5rem; font-size: .82rem; color: #555; }
@media print {
  body { margin: 0; max-width: none; font-size: 11pt; }
  h2, h3 { break-after: avoid; }
  tr, .key { break-inside: avoid; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
)";

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_STYLE_H_
