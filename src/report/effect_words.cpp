#include "report/effect_words.hpp"

#include <map>

namespace tissue_stiffness {

std::string effect_title(const std::string& effect) {
  std::string title = effect;
  for (char& c : title) c = c == '_' ? ' ' : c;
  return title;
}

std::string effect_sign(const std::string& effect) {
  static const std::map<std::string, std::string> signs{
      {"initial_motion", "the body was loaded or moved already when the recording began"},
      {"gravity", "the body hangs or sags as if its weight had been left out"},
      {"pressure", "the wall moves as if a fluid pressed on it that the model does not have"},
      {"traction", "the body moves as if a force pulled on it that the model does not have"},
      {"contact_plane", "the body is stopped where the model lets it pass"},
      {"added_mass", "a part of the body swings more slowly than the model's, as if something heavy hung on it"},
      {"mass_damping", "the motion dies away faster than the model's, slow swings most of all"},
      {"viscous_damping", "the motion dies away faster than the model's, quick vibrations most of all"},
      {"viscoelasticity", "the tissue creeps under a load that lasts and comes back late: stiff when fast, soft when slow"},
      {"elastic_support", "the body moves at its clamp, which is not rigid"},
      {"foundation", "the body is held back where the model leaves it free, as by soft surroundings"},
      {"stiff_inclusion", "one spot deforms less (or more) than the tissue around it, as a lump would"},
      {"fibre_reinforcement", "the tissue resists more along one direction than across it"},
      {"active_contraction", "the tissue moves by itself, in a rhythm that no measured load has"},
      {"compressibility", "the tissue bulges sideways more, or less, than its Poisson's ratio says"},
      {"density_error", "every swing is slower, or faster, than the model's, as if the body's mass were wrong"},
      {"force_scale",
       "every deflection is too large, or too small, by the same share, as if the load sensor's scale were off"},
      {"load_offset", "a constant force bends the body beside the measured one, as if the force sensor's zero were off"},
      {"pressure_offset", "a constant pressure acts beside the measured one, as if the transducer's zero were off"},
      {"load_rotation",
       "the body answers in a direction that is turned against the measured force, as if its sensor were mounted askew"},
      {"image_scale", "everything seen is larger, or smaller, by the same share, as with a wrong pixel size"},
      {"time_offset", "the motion is right but comes late, or early, against the loads: the clocks disagree"},
      {"period_elongation",
       "quick swings take longer than the model's, slow ones do not: a simulation with a long time step"},
      {"rigid_drift", "the whole body wanders or turns steadily, as when the sensor itself moves"},
      {"sensor_rotation",
       "the body moves in a direction that is turned against the model's, as with a misregistered sensor"},
      {"contour_bias", "the outline lies outside, or inside, the surface everywhere by the same distance"},
      {"geometric_nonlinearity", "large deflections turn the body, and a model for small strains does not follow"},
      {"strain_stiffening", "the tissue grows stiffer the further it is stretched"},
  };
  const auto found = signs.find(effect);
  return found == signs.end() ? "the error has the shape that " + effect_title(effect) + " would give it" : found->second;
}

std::string effect_list(const std::vector<std::string>& effects) {
  std::string text;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == effects.size() ? " and " : ", ") + effect_title(effects[i]);
  }
  return text;
}

}  // namespace tissue_stiffness
