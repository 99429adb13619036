#pragma once

namespace tissue_stiffness {

/// Files from resources/report that every report.html contains.
struct ReportAssets {
  const char* page;  ///< template with {{places}} to fill in
  const char *style, *script;
  const char *uplot_style, *uplot, *three;
  const char *uplot_licence, *three_licence;
};
extern const ReportAssets report_assets;

}  // namespace tissue_stiffness
