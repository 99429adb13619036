#pragma once

#include <std_msgs/Header.h>

#include <string>

#include "nodes/messages.hpp"
#include "tissue_stiffness/types/contour.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/feature_tracks.hpp"
#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

// These functions convert between the package's own messages and its types. Incoming messages are checked: InputError names
// the topic, what was found and what is allowed.

ContourMessage to_message(const Contour& contour, const std_msgs::Header& header);
FeatureTracksMessage to_message(const FeatureTracks& tracks, const std_msgs::Header& header);
TetMeshMessage to_message(const TetMesh& mesh, const std_msgs::Header& header);
StiffnessEstimate to_message(const Estimate& estimate, const std_msgs::Header& header);
MisfitMessage to_message(const Misfit& misfit, const std_msgs::Header& header);

/// Converts a contour. Throws InputError for arrays of unequal length, an empty contour, numbers that are not finite (sigma
/// may be infinite), and sigma <= 0.
Contour to_contour(const ContourMessage& message, const std::string& topic);

/// Converts tracks. Throws InputError for arrays of unequal length, numbers that are not finite, sigma <= 0, and a number
/// that comes twice.
FeatureTracks to_tracks(const FeatureTracksMessage& message, const std::string& topic);

/// Converts a mesh. Throws InputError for a node count other than 4 or 10, incomplete arrays, indices out of range, and
/// coordinates that are not finite.
TetMesh to_mesh(const TetMeshMessage& message, const std::string& topic);

}  // namespace tissue_stiffness
