#include "report/write_results.hpp"

#include <filesystem>
#include <ostream>

#include "tissue_stiffness/types/error.hpp"
#include "types/pending_file.hpp"

namespace tissue_stiffness {

void write_text(const std::string& file, const std::string& text) {
  write_file(file, [&](std::ostream& out) { out << text; });
}

void make_folder(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw InputError(directory, error.message(), "a writable folder");
}

void write_results(const Results& results, const Showing& showing, const std::string& directory) {
  make_folder(directory);
  const std::filesystem::path folder(directory);
  if (results.recordings.empty()) write_text((folder / "estimates.csv").string(), estimates_csv(results));
  write_text((folder / "report.html").string(), report_html(results, showing));
  write_text((folder / "results.json").string(), results_json(results));
}

}  // namespace tissue_stiffness
