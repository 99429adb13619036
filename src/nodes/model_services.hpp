#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/messages.hpp"
#include "nodes/model_check.hpp"
#include "tissue_stiffness/AddEffect.h"
#include "tissue_stiffness/ListEffects.h"
#include "tissue_stiffness/RemoveEffect.h"

namespace tissue_stiffness {

/// Gives access to the running model: topics `diagnosis` and `missing_force` (latched), services `diagnose`, `add_effect`,
/// `remove_effect`, `list_effects`. A separate thread serves them, so that a long answer delays no frame.
class ModelServices {
 public:
  /// Runs a changed model from now on. Throws InputError with the reason if that cannot be done.
  using Change = std::function<void(const ModelSettings&)>;

  /// An entry to add may only name files in `directory`, the model's folder: a caller is not its owner.
  ModelServices(const ros::NodeHandle& node, std::string directory, std::string model_frame,
                const ModelCheck::Options& options, Change change);
  ~ModelServices();

  ModelCheck& check() { return check_; }

  /// Sets the running model, that model as it begins in this run, and its mesh.
  void start(const ModelSettings& settings, const ModelSettings& begun, const TetMesh& mesh);

 private:
  bool on_diagnose(Diagnose::Request&, Diagnose::Response& response);
  bool on_add(AddEffect::Request& request, AddEffect::Response& response);
  bool on_remove(RemoveEffect::Request& request, RemoveEffect::Response& response);
  bool on_list(ListEffects::Request&, ListEffects::Response& response);
  /// Applies `edit` to the running model and has it run. Returns the message.
  std::string change_model(const std::function<std::string(ModelSettings&)>& edit);
  std::string entry_of(const std::string& effect) const;
  void publish(const Diagnosis& diagnosis, double stamp);

  const std::string directory_, model_frame_;
  const Change change_;
  std::mutex mutex_;
  std::optional<ModelSettings> settings_;
  std::vector<std::string> added_;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher publisher_, force_publisher_;
  ModelCheck check_;
  std::vector<ros::ServiceServer> services_;
  ros::AsyncSpinner spinner_;
};

}  // namespace tissue_stiffness
