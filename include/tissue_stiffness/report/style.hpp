#pragma once

namespace tissue_stiffness {

/// Style sheet of report.html.
extern const char* const report_style;

}  // namespace tissue_stiffness
