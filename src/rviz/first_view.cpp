#include "rviz/first_view.hpp"

#include <OgreCamera.h>
#include <OgreQuaternion.h>
#include <OgreVector3.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include "rviz/body_view.hpp"

namespace tissue_stiffness {
namespace {

constexpr char kFocalPoint[] = "Focal Point", kDistance[] = "Distance";

/// Returns the named part of a property; null if there is none.
rviz::Property* part(const rviz::Property& of, const QString& name) {
  for (int i = 0; i < of.numChildren(); ++i) {
    if (of.childAt(i)->getName() == name) return of.childAt(i);
  }
  return nullptr;
}

/// Returns the numbers that say where a view looks from; empty for a view without a focal point.
std::vector<double> numbers_of(const rviz::Property* view) {
  if (view == nullptr) return {};
  const rviz::Property* focus = part(*view, kFocalPoint);
  if (focus == nullptr) return {};
  std::vector<double> out;
  for (const rviz::Property* property : {part(*view, kDistance), part(*view, "Yaw"), part(*view, "Pitch"),
                                         part(*focus, "X"), part(*focus, "Y"), part(*focus, "Z")}) {
    if (property == nullptr) return {};
    out.push_back(property->getValue().toDouble());
  }
  return out;
}

Eigen::Matrix3Xd points_of(const visualization_msgs::Marker& body, const Ogre::Vector3& origin,
                           const Ogre::Quaternion& turn) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(body.points.size()));
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    const geometry_msgs::Point& point = body.points[i];
    const Ogre::Vector3 at = origin + turn * Ogre::Vector3(static_cast<float>(point.x), static_cast<float>(point.y),
                                                           static_cast<float>(point.z));
    out.col(static_cast<Eigen::Index>(i)) << at.x, at.y, at.z;
  }
  return out;
}

}  // namespace

void FirstView::start(rviz::DisplayContext& context) {
  context_ = &context;
  left_ = numbers_of(context.getViewManager()->getCurrent());
}

bool FirstView::untouched() const {
  return !left_.empty() && numbers_of(context_->getViewManager()->getCurrent()) == left_;
}

void FirstView::show(const visualization_msgs::Marker& body) {
  waiting_ = waiting_ && untouched();
  if (!waiting_) return;
  Ogre::Vector3 origin;
  Ogre::Quaternion turn;
  if (!context_->getFrameManager()->getTransform(body.header.frame_id, ros::Time(), origin, turn)) return;
  rviz::ViewManager& views = *context_->getViewManager();
  const rviz::RenderPanel& window = *views.getRenderPanel();
  rviz::ViewController& view = *views.getCurrent();
  const double aspect = static_cast<double>(window.width()) / window.height();
  const auto found = view_of_body(points_of(body, origin, turn), view.getCamera()->getFOVy().valueRadians(), aspect);
  if (!found) return;
  rviz::Property& focus = *part(view, kFocalPoint);
  const char* const names[] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) part(focus, names[i])->setValue(found->centre[i]);
  part(view, kDistance)->setValue(found->distance);
  left_ = numbers_of(&view);
  waiting_ = false;
}

}  // namespace tissue_stiffness
