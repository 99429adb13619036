#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// A load's magnitude as a function of the time after the first stamp [s].
using Signal = std::function<double(double)>;

/// Reads one of
///   ramp: {from, to, start, end}          linear between start and end, constant outside; from defaults to 0
///   sine: {amplitude, frequency, phase}   amplitude sin(2 pi frequency t + phase)
///   raised_cosine: {amplitude, frequency} amplitude (1 - cos(2 pi frequency t)) / 2
///   steps: {times, values}                the value of the last time passed, 0 before the first
///   csv: {file}                           rows of time and value, linear between them
/// Throws InputError for another key, a value out of range or a file that cannot be read.
Signal read_signal(const Value& map, const std::string& directory);

}  // namespace tissue_stiffness
