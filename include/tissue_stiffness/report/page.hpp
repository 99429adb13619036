#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/diagnosis.hpp"
#include "tissue_stiffness/types/replay.hpp"

namespace tissue_stiffness {

/// One self-contained page: what is said is in `body`, what is drawn in `data`.
struct Page {
  std::string title, heading, subheading;  ///< plain text
  std::string body;                        ///< HTML
  std::string data;                        ///< JSON
  std::string html() const;
};

// Pieces of a body. Texts are escaped, `content` is HTML.

/// A card; nothing when there is no content.
std::string section(const std::string& id, const std::string& title, const std::string& content);

/// Says that the work was interrupted, and during what, and what the page then holds; nothing when `interrupted` is empty.
std::string interruption_notice(const std::string& interrupted);

/// A file with the folder that it lies in.
std::string short_path(const std::string& file);

/// The place of a chart, which the page's script fills: `id` is known to it.
std::string chart_place(const std::string& id);

/// Card in which model and measurement move; nothing without a replay. `arrows`: with the missing force.
std::string player(const Showing& showing, bool arrows = false);

/// A text file to fold out. Lines that `before` lacks are marked when it is not empty.
std::string file_details(const std::string& summary, const std::string& text, const std::string& before, bool open);

/// How to make the page again: command line, versions, and the libraries that the page carries, with their licences.
std::string colophon(const std::string& command_line, const std::vector<std::pair<std::string, std::string>>& versions);

/// {first_stamp, replays, pictures}. Rounded: positions to 1/64000 of their range, misfits to 1/254 of the root of theirs.
std::string showing_json(const Showing& showing);
/// {time, places, field}, thinned and rounded alike; null where nothing is missing.
std::string arrows_json(const MissingForce& force);

}  // namespace tissue_stiffness
