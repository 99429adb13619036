#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

namespace rviz {
class DisplayContext;
}

namespace tissue_stiffness {

/// Turns rviz's view to a body once, unless the user has moved the view. The view needs a focal point and a distance, as
/// rviz's Orbit and XYOrbit have; others stay as they are.
class FirstView {
 public:
  /// From now on a view that differs from the present one is the user's. `context` must outlive this object.
  void start(rviz::DisplayContext& context);
  /// Waits for another body, unless the user has moved the view.
  void wait_for_body() { waiting_ = untouched(); }
  bool waiting() const { return waiting_; }
  /// Shows a body if one is waited for. While tf does not know its frame, the next one is waited for.
  void show(const visualization_msgs::Marker& body);
  /// Returns whether this object has been started and the view is as this object left it.
  bool untouched() const;

 private:
  rviz::DisplayContext* context_ = nullptr;
  std::vector<double> left_;  ///< the view's numbers; empty for a view without them
  bool waiting_ = false;
};

}  // namespace tissue_stiffness
