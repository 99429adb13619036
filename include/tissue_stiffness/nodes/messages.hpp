#pragma once

// The package's own messages. Generated headers put their types into the namespace of the package, where the core has its
// nouns of the same names; so the typedefs of these are renamed. On the wire nothing changes.
#include <geometry_msgs/Point.h>
#include <ros/message_operations.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#define Contour ContourMessage
#define TetMesh TetMeshMessage
#define Misfit MisfitMessage
#define MissingEffect MissingEffectMessage
#define Diagnosis DiagnosisMessage
#define StiffnessMap StiffnessMapMessage
#include <tissue_stiffness/Contour.h>
#include <tissue_stiffness/Diagnose.h>
#include <tissue_stiffness/Diagnosis.h>
#include <tissue_stiffness/Misfit.h>
#include <tissue_stiffness/MissingEffect.h>
#include <tissue_stiffness/StiffnessMap.h>
#include <tissue_stiffness/TetMesh.h>
#undef Contour
#undef TetMesh
#undef Misfit
#undef MissingEffect
#undef Diagnosis
#undef StiffnessMap

#include <tissue_stiffness/StiffnessEstimate.h>
