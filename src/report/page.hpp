#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/diagnosis.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// One self-contained page. Its text is in `body`, and the data of its charts in `data`.
struct Page {
  std::string title, heading, subheading;  ///< plain text
  std::string body;                        ///< HTML
  std::string data;                        ///< JSON
  std::string html() const;
};

// These functions return parts of a body. They escape texts; `content` is HTML.

/// Returns a card; nothing when there is no content.
std::string section(const std::string& id, const std::string& title, const std::string& content);

/// Says during which step the work was interrupted, and what the page then holds. Returns nothing when `interrupted` is
/// empty.
std::string interruption_notice(const std::string& interrupted);

/// Returns the name of a file with its folder.
std::string short_path(const std::string& file);

/// Returns the paths without the folders that all of them lie in.
std::vector<std::string> without_common_folders(const std::vector<std::string>& paths);

/// Returns the place of a chart. The page's script knows `id` and fills the place.
std::string chart_place(const std::string& id);

/// Returns the card that animates model and measurement; nothing without a replay. `arrows`: show the missing force.
std::string player(const Showing& showing, bool arrows = false);

/// Returns a text file that can be unfolded; nothing when it is empty.
std::string file_details(const std::string& summary, const std::string& text, bool open);

/// Says how to make the page again: command line, `remark`, versions, and the libraries that the page contains, with their
/// licences.
std::string colophon(const std::string& command_line, const std::vector<std::pair<std::string, std::string>>& versions,
                     const std::string& remark = "");

/// Returns {first_stamp, replays, pictures}. Positions are rounded to 1/64000 of their range, misfits to 1/254 of the root
/// of theirs.
std::string showing_json(const Showing& showing);
/// Returns {time, places, field}, thinned and rounded alike; null where nothing is missing.
std::string arrows_json(const MissingForce& force);

}  // namespace tissue_stiffness
