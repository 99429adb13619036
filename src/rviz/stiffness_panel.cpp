#include "rviz/stiffness_panel.hpp"

#include <rviz/visualization_manager.h>

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>
#include <functional>
#include <pluginlib/class_list_macros.hpp>

#include "rviz/curve_view.hpp"
#include "rviz/effect_list.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kRefreshMilliseconds = 50;
constexpr char kShowWholeBody[] = "Show Whole Body";  // key of the saved config

// Two of the colours of Okabe and Ito, which colour-blind people tell apart.
const QColor kBlue(0x00, 0x72, 0xb2), kVermilion(0xd5, 0x5e, 0x00);

QString text(const std::string& from) {
  return QString::fromStdString(from);
}

void show_badge(QLabel& label, const Badge& badge) {
  label.setText(text(badge.text));
  label.setStyleSheet(QString("QLabel { background: #%1; color: white; border-radius: 9px; padding: 2px 10px; }")
                          .arg(badge.colour, 6, 16, QLatin1Char('0')));
}

QLabel* name_it(QLabel* label, const char* name) {
  label->setObjectName(name);
  return label;
}

}  // namespace

StiffnessPanel::StiffnessPanel(QWidget* parent) : rviz::Panel(parent), calls_(std::make_unique<ServiceCalls>()) {
  setObjectName("tissue_stiffness_panel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 8, 8, 8);
  build_header();
  build_legend();
  layout->addWidget(modulus_view_ = new CurveView(kBlue, "95 % interval", "", this), 4);
  layout->addWidget(misfit_view_ = new CurveView(kVermilion, "", "noise alone", this), 4);

  auto* missing = new QHBoxLayout;
  missing->addWidget(new QLabel("<b>What the model misses</b>", this), 1);
  missing->addWidget(verdict_badge_ = name_it(new QLabel(this), "verdict"));
  layout->addLayout(missing);
  layout->addWidget(summary_ = name_it(new QLabel(this), "summary"));
  summary_->setWordWrap(true);
  layout->addWidget(effects_ = new EffectList(this), 4);
  effects_->setObjectName("effects");
  build_buttons();

  auto* place = new QHBoxLayout;
  place->addWidget(new QLabel("Namespace", this));
  place->addWidget(namespace_ = new QLineEdit(this), 1);
  namespace_->setObjectName("namespace");
  namespace_->setPlaceholderText("of the estimator; empty: rviz's own");
  layout->addLayout(place);
  connect(namespace_, &QLineEdit::editingFinished, this, [this] {
    if (node_ && node_->getUnresolvedNamespace() == namespace_->text().toStdString()) return;
    connect_to(namespace_->text());
    Q_EMIT configChanged();
  });

  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, &StiffnessPanel::take_messages);
  timer->start(kRefreshMilliseconds);
  connect_to("");
}

StiffnessPanel::~StiffnessPanel() {
  calls_.reset();  // before what its answers speak to
  subscribers_.clear();
  body_.shutdown();
}

void StiffnessPanel::build_header() {
  auto* layout = static_cast<QVBoxLayout*>(this->layout());
  auto* top = new QHBoxLayout;
  top->addWidget(quantity_ = name_it(new QLabel(this), "quantity"), 1);
  top->addWidget(state_badge_ = name_it(new QLabel(this), "state"));
  layout->addLayout(top);
  layout->addWidget(headline_ = name_it(new QLabel(this), "headline"));
  QFont large = headline_->font();
  large.setPointSizeF(2.0 * large.pointSizeF());
  large.setBold(true);
  headline_->setFont(large);
  headline_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* below = new QHBoxLayout;
  below->addWidget(interval_ = name_it(new QLabel(this), "interval"), 1);
  below->addWidget(misfit_ = name_it(new QLabel(this), "misfit"));
  layout->addLayout(below);
  layout->addWidget(state_reason_ = name_it(new QLabel(this), "state_reason"));
  state_reason_->setWordWrap(true);
}

/// Says what the colours of the surface and the other things in the view mean.
void StiffnessPanel::build_legend() {
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel("Surface: misfit 0", this));
  auto* scale = name_it(new QLabel(this), "legend");
  scale->setMinimumWidth(60);
  scale->setFixedHeight(12);
  scale->setStyleSheet(
      "background: qlineargradient(x1:0, y1:0, x2:1, y2:0, stop:0 #3b6fb6, stop:0.25 #6fb7c9, stop:0.5 #f4e8a4, "
      "stop:0.75 #f0904a, stop:1 #b5172f); border-radius: 4px;");
  row->addWidget(scale, 1);
  row->addWidget(colour_limit_ = name_it(new QLabel(this), "colour_limit"));
  auto* layout = static_cast<QVBoxLayout*>(this->layout());
  layout->addLayout(row);
  auto* words = new QLabel("Grey: not measured. White balls: measured points. Arrows: missing force.", this);
  words->setWordWrap(true);
  layout->addWidget(words);
}

void StiffnessPanel::show_colour_limit(const dynamic_reconfigure::Config& options) {
  for (const dynamic_reconfigure::DoubleParameter& option : options.doubles) {
    if (option.name == "colour_limit") colour_limit_->setText(QString::number(option.value) + " sigma");
  }
}

void StiffnessPanel::build_buttons() {
  auto* row = new QHBoxLayout;
  const auto button = [&](const char* name, const char* label, const char* tip, void (StiffnessPanel::*pressed)()) {
    auto* out = new QPushButton(label, this);
    out->setObjectName(name);
    out->setToolTip(tip);
    connect(out, &QPushButton::clicked, this, pressed);
    row->addWidget(out);
    return out;
  };
  diagnose_ = button("diagnose", "Diagnose", "Search now for the effect that the running model misses",
                     &StiffnessPanel::on_diagnose);
  add_ = button("add", "Add", "Put the selected effect, or the best, into the running model", &StiffnessPanel::on_add);
  remove_ =
      button("remove", "Remove", "Take the selected added effect, or the last, out again", &StiffnessPanel::on_remove);
  reset_ = button("reset", "Reset", "Let the next frame start from the prior", &StiffnessPanel::on_reset);
  auto* layout = static_cast<QVBoxLayout*>(this->layout());
  layout->addLayout(row);
  layout->addWidget(status_ = name_it(new QLabel(this), "status"));
  status_->setWordWrap(true);
}

void StiffnessPanel::connect_to(const QString& node_namespace) {
  subscribers_.clear();
  body_.shutdown();
  state_.clear();
  waiting_ = false;
  ++connection_;  // answers of the one before are not ours any more
  show_estimate();
  show_effects();
  try {
    node_ = std::make_unique<ros::NodeHandle>(node_namespace.toStdString());
  } catch (const ros::InvalidNameException& error) {
    status_->setText(error.what());
    return;
  }
  node_->setCallbackQueue(&queue_);
  colour_limit_->clear();
  using dynamic_reconfigure::Config;
  subscribers_ = {
      node_->subscribe<Config>("estimator_node/parameter_updates", 10,
                               [this](const Config::ConstPtr& message) { show_colour_limit(*message); }),
      node_->subscribe<StiffnessEstimate>("stiffness", 1000,
                                          [this](const StiffnessEstimate::ConstPtr& message) {
                                            state_.take(*message);
                                            estimate_changed_ = true;
                                          }),
      node_->subscribe<MisfitMessage>("misfit", 1000,
                                      [this](const boost::shared_ptr<const MisfitMessage>& message) {
                                        state_.take(*message);
                                        estimate_changed_ = true;
                                      }),
      node_->subscribe<DiagnosisMessage>("diagnosis", 10, [this](const boost::shared_ptr<const DiagnosisMessage>& message) {
        state_.take(*message);
        effects_changed_ = true;
      })};
  await_body();
  status_->clear();
  ask_what_was_added();
}

void StiffnessPanel::await_body() {
  first_view_.wait_for_body();
  if (!first_view_.waiting()) return;
  using visualization_msgs::Marker;
  body_ = node_->subscribe<Marker>("tracked_surface", 1,
                                   [this](const Marker::ConstPtr& surface) { first_view_.show(*surface); });
}

void StiffnessPanel::ask_what_was_added() {
  calls_->list_effects(*node_, in_gui([this](const ServiceCalls::Answer& answer) {
    if (answer.added_known) state_.set_added(answer.added);
    effects_changed_ = true;
  }));
}

void StiffnessPanel::take_messages() {
  queue_.callAvailable(ros::WallDuration(0));
  if (!first_view_.waiting()) body_.shutdown();  // a surface is large
  if (state_.model_changed() && !waiting_) ask_what_was_added();
  if (estimate_changed_) show_estimate();
  if (effects_changed_) show_effects();
}

void StiffnessPanel::show_estimate() {
  estimate_changed_ = false;
  quantity_->setText("<b>" + text(state_.quantity()).toHtmlEscaped() + "</b>");
  headline_->setText(text(state_.headline()));
  interval_->setText(text(state_.interval()));
  misfit_->setText(text(state_.misfit()));
  show_badge(*state_badge_, state_.state());
  state_reason_->setText(text(state_.state_reason()));
  modulus_view_->show_curve(state_.modulus_curve(), text(state_.quantity()), text(state_.modulus_axis()));
  show_misfit();
}

void StiffnessPanel::show_misfit() {
  misfit_view_->show_curve(state_.misfit_curve(), "misfit (rms)", "misfit [mm]", state_.noise_floor());
}

void StiffnessPanel::show_effects() {
  effects_changed_ = false;
  show_badge(*verdict_badge_, state_.verdict());
  summary_->setText(text(state_.summary()));
  effects_->show_rows(state_.rows());
  show_misfit();
  add_->setEnabled(!waiting_ && !chosen(false).empty());
  remove_->setEnabled(!waiting_ && !chosen(true).empty());
  diagnose_->setEnabled(!waiting_);
  reset_->setEnabled(!waiting_);
}

std::string StiffnessPanel::chosen(bool added) const {
  const std::string selected = effects_->selected(added);
  if (!selected.empty()) return selected;
  return added ? state_.last_added() : state_.best_candidate();
}

void StiffnessPanel::on_diagnose() {
  wait_for("searching for the effect that the model misses ...");
  calls_->diagnose(*node_, when_answered());
}

void StiffnessPanel::on_add() {
  const std::string effect = chosen(false);
  wait_for("adding " + text(effect) + " ...");
  calls_->add_effect(*node_, effect, when_answered());
}

void StiffnessPanel::on_remove() {
  const std::string effect = chosen(true);
  wait_for("removing " + text(effect) + " ...");
  calls_->remove_effect(*node_, effect, when_answered());
}

void StiffnessPanel::on_reset() {
  wait_for("resetting ...");
  calls_->reset(*node_, when_answered());
}

void StiffnessPanel::wait_for(const QString& what) {
  waiting_ = true;
  status_->setText(what);
  show_effects();
}

ServiceCalls::Done StiffnessPanel::in_gui(ServiceCalls::Done done) {
  return [this, done = std::move(done), connection = connection_](const ServiceCalls::Answer& answer) {
    const auto deliver = [this, done, connection, answer] {
      if (connection == connection_) done(answer);
    };
    QMetaObject::invokeMethod(this, deliver, Qt::QueuedConnection);
  };
}

ServiceCalls::Done StiffnessPanel::when_answered() {
  return in_gui([this](const ServiceCalls::Answer& answer) {
    waiting_ = false;
    if (answer.added_known) state_.set_added(answer.added);
    status_->setText(text(answer.message));
    show_effects();
  });
}

void StiffnessPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  bool show_whole_body = false;
  if (config.mapGetBool(kShowWholeBody, &show_whole_body) && show_whole_body) first_view_.start(*vis_manager_);
  QString node_namespace;
  config.mapGetString("Namespace", &node_namespace);
  namespace_->setText(node_namespace);
  connect_to(node_namespace);
}

void StiffnessPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Namespace", namespace_->text());
  config.mapSetValue(kShowWholeBody, first_view_.untouched());
}

}  // namespace tissue_stiffness

PLUGINLIB_EXPORT_CLASS(tissue_stiffness::StiffnessPanel, rviz::Panel)
