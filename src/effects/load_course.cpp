#include <algorithm>

#include "effects/registry.hpp"
#include "settings/inside_folder.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Effects of one model share the course of a file or topic.
std::shared_ptr<Course> course_of(const Value& arguments, LoadInput::Kind kind, const EffectContext& context) {
  if (arguments.has("course")) {
    auto& course = context.courses["file:" + arguments.at("course").at("file").as_text()];
    if (course == nullptr || course->kind() != kind) course = load_csv(arguments.at("course"), kind, context);
    return course;
  }
  const std::string topic = arguments.at("topic").as_text();
  const auto same = [&](const LoadInput& input) { return input.topic == topic; };
  const auto known = std::find_if(context.inputs.begin(), context.inputs.end(), same);
  if (known == context.inputs.end()) {
    context.inputs.push_back({topic, kind});
    context.courses[topic] = std::make_shared<Course>(kind);
  } else if (known->kind != kind) {
    throw InputError(arguments.at("topic").path(), topic, "one type of message a topic");
  }
  return context.courses[topic];
}

}  // namespace

std::shared_ptr<Course> load_csv(const Value& course, LoadInput::Kind kind, const EffectContext& context) {
  return std::make_shared<Course>(
      Course::from_csv(path_from(context.settings.directory, course.at("file").as_text()), kind));
}

std::shared_ptr<Course> load_course(const Value& arguments, LoadInput::Kind kind, const EffectContext& context) {
  if (arguments.has("topic") == arguments.has("course")) {
    throw InputError(arguments.path(), arguments.has("topic") ? "topic and course" : "neither topic nor course",
                     "one of the two");
  }
  const bool wrench = kind == LoadInput::Kind::wrench;
  const std::shared_ptr<Course> course = course_of(arguments, kind, context);
  if (wrench && arguments.has("torque_about")) course->use_torque();
  course->set_tolerance(kind == LoadInput::Kind::pose ? read_motion_tolerance(arguments)
                                                      : read_load_tolerance(arguments, wrench, course->acting() == 6));
  return course;
}

}  // namespace tissue_stiffness
