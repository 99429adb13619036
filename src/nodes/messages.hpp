#pragma once

// The package's own messages. Generated headers put their types into the package's namespace, where the core has types with
// equal names. So these typedefs have other names. The messages themselves are not changed.
#include <geometry_msgs/Point.h>
#include <ros/message_operations.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#define Contour ContourMessage
#define FeatureTracks FeatureTracksMessage
#define TetMesh TetMeshMessage
#define Misfit MisfitMessage
#define MissingEffect MissingEffectMessage
#define Diagnosis DiagnosisMessage
#define StiffnessMap StiffnessMapMessage
#include <tissue_stiffness/Contour.h>
#include <tissue_stiffness/Diagnose.h>
#include <tissue_stiffness/Diagnosis.h>
#include <tissue_stiffness/FeatureTracks.h>
#include <tissue_stiffness/Misfit.h>
#include <tissue_stiffness/MissingEffect.h>
#include <tissue_stiffness/StiffnessMap.h>
#include <tissue_stiffness/TetMesh.h>
#undef Contour
#undef FeatureTracks
#undef TetMesh
#undef Misfit
#undef MissingEffect
#undef Diagnosis
#undef StiffnessMap

#include <tissue_stiffness/StiffnessEstimate.h>
