#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "effects/effect.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

/// Returns the time course of a measured load from the keys `topic` or `course: {file}`. Registers the topic in
/// context.inputs.
std::shared_ptr<Course> load_course(const Value& arguments, LoadInput::Kind kind, const EffectContext& context);

/// Returns a course from {file: ...}, relative to the model file's folder. Times count from the recording's first stamp.
std::shared_ptr<Course> load_csv(const Value& course, LoadInput::Kind kind, const EffectContext& context);

/// Returns the library: every effect's spec, in the order of effects.def.
const std::vector<EffectSpec>& effect_specs();

/// Returns the spec of an entry's effect. Throws InputError naming the existing effects.
const EffectSpec& effect_spec(const EffectSettings& settings);

/// Returns the tetrahedra that an elasticity fills. Throws InputError for a region without any.
std::vector<int> solid_elements(const Value& arguments, int element_count, const std::map<std::string, Region>& regions);

/// Returns the region. Throws InputError naming the key and the existing regions.
const Region& find_region(const Value& name, const std::map<std::string, Region>& regions);
/// Returns the region as find_region does. Throws InputError, too, for a region without boundary facets.
const Region& find_surface(const Value& name, const std::map<std::string, Region>& regions);

/// Returns values and priors of an effect's parameters in the order of the spec, with one entry for each component of a
/// vector. Throws InputError for a value that is missing or out of bounds.
std::vector<Quantity> read_parameters(const EffectSettings& settings);

/// Builds an effect. read_parameters must have been called. Throws InputError for a key that is missing, wrong or unknown.
std::unique_ptr<Effect> make_effect(const EffectSettings& settings, const EffectContext& context);

}  // namespace tissue_stiffness
