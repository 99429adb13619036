#pragma once

namespace tissue_stiffness {

/// What every report.html carries, from resources/report.
struct ReportAssets {
  const char* page;  ///< template with {{places}}
  const char *style, *script;
  const char *uplot_style, *uplot, *three;
  const char *uplot_licence, *three_licence;
};
extern const ReportAssets report_assets;

}  // namespace tissue_stiffness
