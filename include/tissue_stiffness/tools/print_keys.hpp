#pragma once

#include <ostream>

namespace tissue_stiffness {

/// Keys of a model file and private parameters of the nodes, for a terminal.
void print_keys(std::ostream& out);

/// The same as a Markdown page.
void print_keys_markdown(std::ostream& out);

}  // namespace tissue_stiffness
