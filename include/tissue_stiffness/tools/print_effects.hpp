#pragma once

#include <ostream>

namespace tissue_stiffness {

/// The library of effects, for a terminal.
void print_effects(std::ostream& out);

/// The same as a Markdown page.
void print_effects_markdown(std::ostream& out);

/// The names alone, one a line.
void print_effect_names(std::ostream& out);

/// A list of {name, summary, formula, source, parameters[], keys{}}; a bound that is infinite, or a default that does not
/// exist, is null.
void print_effects_json(std::ostream& out);

}  // namespace tissue_stiffness
