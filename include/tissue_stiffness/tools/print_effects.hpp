#pragma once

#include <ostream>

namespace tissue_stiffness {

/// The library of effects, for a terminal.
void print_effects(std::ostream& out);

/// The same as a Markdown page.
void print_effects_markdown(std::ostream& out);

}  // namespace tissue_stiffness
