#pragma once

#include <ostream>

namespace tissue_stiffness {

/// Prints the library of effects for a terminal.
void print_effects(std::ostream& out);

/// Prints the library of effects as a Markdown page.
void print_effects_markdown(std::ostream& out);

/// Prints the names of the effects, one in each line.
void print_effect_names(std::ostream& out);

/// Prints a list of {name, summary, formula, source, parameters[], keys{}}. An infinite bound or a missing default is null.
void print_effects_json(std::ostream& out);

}  // namespace tissue_stiffness
