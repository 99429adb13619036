#include "forward/loads.hpp"

#include <iomanip>
#include <sstream>

namespace tissue_stiffness {

void Loads::set_first_stamp(double time) {
  first_stamp_ = time;
  for (auto& course : courses_) course.second->start(time, time + rest_);
}

void Loads::drive(double first_stamp, const std::vector<LoadSample>& samples) {
  set_first_stamp(first_stamp);
  for (const LoadSample& sample : samples) {
    const auto course = courses_.find(sample.topic);
    if (course != courses_.end()) course->second->add(sample.time, sample.value);
  }
}

std::string Loads::silence(double time) const {
  for (const LoadInput& input : inputs_) {
    const std::optional<Course::Silence> silence = courses_.at(input.topic)->silence(time);
    if (!silence) continue;
    std::ostringstream text;
    text << "no load on " << input.topic << " for " << std::setprecision(3) << silence->since
         << " s, where one comes every " << silence->interval << " s";
    return text.str();
  }
  return "";
}

double Loads::value(const LoadTerm& term, const Parameters& parameters, double factor, double time) const {
  return (term.course && !term.prescribed ? factor : 1.0) * term.value(time, time - first_stamp_, parameters);
}

}  // namespace tissue_stiffness
