#include "tissue_stiffness/report/write_results.hpp"

#include <filesystem>
#include <fstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

void write_text(const std::string& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw InputError(file, "a file that cannot be written", "a writable folder");
}

void write_results(const Results& results, const Showing& showing, const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw InputError(directory, error.message(), "a writable folder");
  const std::filesystem::path folder(directory);
  write_text((folder / "results.json").string(), results_json(results));
  write_text((folder / "estimates.csv").string(), estimates_csv(results));
  write_text((folder / "report.html").string(), report_html(results, showing));
}

}  // namespace tissue_stiffness
