#include "rviz/service_calls.hpp"

#include <ros/service.h>
#include <std_srvs/Trigger.h>

#include <utility>

#include "nodes/messages.hpp"
#include "tissue_stiffness/AddEffect.h"
#include "tissue_stiffness/ListEffects.h"
#include "tissue_stiffness/RemoveEffect.h"

namespace tissue_stiffness {

ServiceCalls::ServiceCalls() : thread_([this] { run(); }) {}

ServiceCalls::~ServiceCalls() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    calls_.clear();
    running_.shutdown();  // its connection drops, and the call comes back
  }
  changed_.notify_all();
  thread_.join();
}

void ServiceCalls::enqueue(std::function<Answer()> call, Done done) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    calls_.emplace_back(std::move(call), std::move(done));
  }
  changed_.notify_all();
}

void ServiceCalls::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopped_ || !calls_.empty(); });
    if (stopped_) return;
    const auto [call, done] = std::move(calls_.front());
    calls_.pop_front();
    lock.unlock();
    const Answer answer = call();
    lock.lock();
    if (!stopped_) done(answer);
  }
}

template <typename Service>
ServiceCalls::Answer ServiceCalls::ask(ros::NodeHandle node, const std::string& name, Service& service) {
  Answer answer;
  if (!node.ok() || !ros::service::exists(node.resolveName(name), false)) {
    answer.message = "no service " + node.resolveName(name) + ": is the estimator running, and the namespace right?";
    return answer;
  }
  // Only a persistent client drops its connection when it is shut down.
  ros::ServiceClient client = node.serviceClient<Service>(name, true);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopped_) return answer;
    running_ = client;
  }
  answer.success = client.call(service);
  if (!answer.success) answer.message = node.resolveName(name) + " gave no answer";
  const std::lock_guard<std::mutex> lock(mutex_);
  running_ = ros::ServiceClient();
  return answer;
}

ServiceCalls::Answer ServiceCalls::with_added(const ros::NodeHandle& node, Answer answer) {
  ListEffects list;
  if (ask(node, "list_effects", list).success) {
    answer.added = list.response.added;
    answer.added_known = true;
  }
  return answer;
}

template <typename Service>
void ServiceCalls::call(const ros::NodeHandle& node, const std::string& name, Service service, bool changes_model,
                        Done done) {
  enqueue(
      [this, node, name, service, changes_model]() mutable {
        const Answer answer = ask(node, name, service);
        if (!answer.success) return answer;
        Answer said{service.response.success != 0, service.response.message, {}, false};
        return changes_model ? with_added(node, std::move(said)) : said;
      },
      std::move(done));
}

void ServiceCalls::diagnose(const ros::NodeHandle& node, Done done) {
  call(node, "diagnose", Diagnose(), false, std::move(done));
}

void ServiceCalls::add_effect(const ros::NodeHandle& node, const std::string& effect, Done done) {
  AddEffect service;
  service.request.effect = effect;
  call(node, "add_effect", service, true, std::move(done));
}

void ServiceCalls::remove_effect(const ros::NodeHandle& node, const std::string& effect, Done done) {
  RemoveEffect service;
  service.request.effect = effect;
  call(node, "remove_effect", service, true, std::move(done));
}

void ServiceCalls::reset(const ros::NodeHandle& node, Done done) {
  call(node, "reset", std_srvs::Trigger(), false, std::move(done));
}

void ServiceCalls::list_effects(const ros::NodeHandle& node, Done done) {
  enqueue([=] { return with_added(node, {true, "", {}, false}); }, std::move(done));
}

}  // namespace tissue_stiffness
