#pragma once

#include <dynamic_reconfigure/Config.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <rviz/panel.h>

#include <memory>
#include <string>
#include <vector>

#include "rviz/first_view.hpp"
#include "rviz/panel_state.hpp"
#include "rviz/service_calls.hpp"

class QLabel;
class QLineEdit;
class QPushButton;

namespace tissue_stiffness {

class CurveView;
class EffectList;

/// rviz panel of one estimator. It shows E with its interval, the misfit, the state and what the model misses. Its buttons
/// start a diagnosis, add and remove effects, and reset the estimator. Messages are processed in the GUI's thread, and
/// services are called in another one. Where the config says so, rviz's view is turned to the first surface that comes. The
/// config keeps this as long as the user has not moved the view, and the estimator's namespace.
class StiffnessPanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit StiffnessPanel(QWidget* parent = nullptr);
  ~StiffnessPanel() override;

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;
  QSize sizeHint() const override { return {380, 720}; }

 private:
  void build_header();
  void build_legend();
  void build_buttons();
  void connect_to(const QString& node_namespace);
  /// Turns the view to the next surface, if the view is still the config's.
  void await_body();
  void ask_what_was_added();
  void take_messages();
  void show_estimate();
  void show_misfit();
  void show_effects();
  /// Shows in the legend from which misfit on the surface is red.
  void show_colour_limit(const dynamic_reconfigure::Config& options);
  /// Returns the effect of the selected row if it is an added one (or not, for `added` = false). Otherwise returns the
  /// button's default.
  std::string chosen(bool added) const;
  void on_diagnose();
  void on_add();
  void on_remove();
  void on_reset();
  /// Disables the buttons until an answer comes, and shows `text`. It does not block.
  void wait_for(const QString& text);
  /// Wraps `done` so that it runs in the GUI's thread, unless the panel has been connected to another estimator.
  ServiceCalls::Done in_gui(ServiceCalls::Done done);
  /// Returns a function that enables the buttons again and shows the answer.
  ServiceCalls::Done when_answered();

  ros::CallbackQueue queue_;
  std::unique_ptr<ros::NodeHandle> node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber body_;
  FirstView first_view_;
  PanelState state_;
  bool estimate_changed_ = true, effects_changed_ = true, waiting_ = false;
  unsigned connection_ = 0;

  QLabel *quantity_ = nullptr, *headline_ = nullptr, *interval_ = nullptr, *misfit_ = nullptr, *state_badge_ = nullptr,
         *state_reason_ = nullptr;
  QLabel *verdict_badge_ = nullptr, *summary_ = nullptr, *status_ = nullptr, *colour_limit_ = nullptr;
  CurveView *modulus_view_ = nullptr, *misfit_view_ = nullptr;
  EffectList* effects_ = nullptr;
  QPushButton *diagnose_ = nullptr, *add_ = nullptr, *remove_ = nullptr, *reset_ = nullptr;
  QLineEdit* namespace_ = nullptr;
  std::unique_ptr<ServiceCalls> calls_;
};

}  // namespace tissue_stiffness
