#include "types/plain_number.hpp"

#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace tissue_stiffness {

std::string with_decimals(double value, int decimals) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::fixed << std::setprecision(decimals) << value;
  return stream.str();
}

std::string fixed_number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  const std::string text = with_decimals(value, decimals);
  return text.find_first_of("123456789") == std::string::npos ? with_decimals(0.0, decimals) : text;
}

std::string position_in_millimetres(const Eigen::Vector3d& position) {
  const auto along = [&](Eigen::Index axis) { return fixed_number(1e3 * position[axis], 0); };
  return "(" + along(0) + ", " + along(1) + ", " + along(2) + ")";
}

int leading_place(double value, int digits) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::scientific << std::setprecision(digits - 1) << value;
  return std::stoi(stream.str().substr(stream.str().find('e') + 1));
}

}  // namespace tissue_stiffness
