#pragma once

#include <ostream>

namespace tissue_stiffness {

/// Prints the keys of a model file and the private parameters of the nodes for a terminal.
void print_keys(std::ostream& out);

/// Prints these keys and parameters as a Markdown page.
void print_keys_markdown(std::ostream& out);

}  // namespace tissue_stiffness
