#include "types/plain_number.hpp"

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

int leading_place(double value, int digits) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::scientific << std::setprecision(digits - 1) << value;
  return std::stoi(stream.str().substr(stream.str().find('e') + 1));
}

}  // namespace tissue_stiffness
