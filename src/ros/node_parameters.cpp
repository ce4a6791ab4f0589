#include "node_parameters.h"

#include <ros/param.h>

#include <algorithm>

#include "autopilot_messages.h"
#include "parameter_names.h"
#include "uav_landing/parameters/section_loader.h"

namespace uav_landing {
namespace {

/// A plain value. Lists and maps become an empty list: no parameter is one, and the parameter server's may be
/// nested without end.
YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeStruct:
    case XmlRpc::XmlRpcValue::TypeArray:
      return YAML::Node(YAML::NodeType::Sequence);
    default:
      return YAML::Node();
  }
}

/// Somebody else's: image_transport's plugins write theirs below the nodelet's name as well, as maps under
/// the topic's name or their own, and they outlive the nodelet. No parameter of ours is a map.
bool isForeign(const std::string& name, XmlRpc::XmlRpcValue& value, const std::vector<std::string>& own) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeStruct &&
         std::find(own.begin(), own.end(), name) == own.end() && suggestName(name, own).empty();
}

/// Takes the keys of NodeParameters out of the map of all private parameters.
YAML::Node takeNodeKeys(YAML::Node& all) {
  YAML::Node taken(YAML::NodeType::Map);
  for (const std::string& name : parameterNames<NodeParameters>()) {
    if (!all[name]) continue;
    taken[name] = all[name];
    all.remove(name);
  }
  return taken;
}

}  // namespace

template <class Section>
Failure loadParameters(const ros::NodeHandle& private_handle, const std::string& section, Section& parameters,
                       NodeParameters& node_parameters) {
  XmlRpc::XmlRpcValue given;
  YAML::Node all(YAML::NodeType::Map);
  if (ros::param::get(private_handle.getNamespace(), given)) {
    if (given.getType() != XmlRpc::XmlRpcValue::TypeStruct)
      return {Reason::kInputInvalid, section + ": expected a map of names and values"};
    const std::vector<std::string> names = parameterNames<NodeParameters, Section>();
    for (auto& member : given)
      if (!isForeign(member.first, member.second, names)) all[member.first] = toYaml(member.second);
  }
  SectionLoader loader(takeNodeKeys(all), section);
  NodeParameters loaded = node_parameters;
  loaded.visit(loader);
  const Failure failure = loader.finish();
  if (failure) return failure;
  if (!loaded.config_file.empty()) {
    if (const auto file = loadParameterFile(loaded.config_file); !file) return file.error();
  }
  node_parameters = loaded;
  SectionLoader own(all, section);
  Section loaded_section = parameters;
  loaded_section.visit(own);
  const Failure own_failure = own.finish();
  if (!own_failure) parameters = loaded_section;
  return own_failure;
}

Failure loadRigParameters(const ros::NodeHandle& handle, RigParameters& parameters) {
  constexpr const char* kSection = "rig";
  XmlRpc::XmlRpcValue given;
  if (!handle.getParam(kSection, given)) return {};
  if (given.getType() != XmlRpc::XmlRpcValue::TypeStruct)
    return {Reason::kInputInvalid, std::string(kSection) + ": expected a map of names and values"};
  YAML::Node all(YAML::NodeType::Map);
  for (auto& member : given) all[member.first] = toYaml(member.second);
  SectionLoader loader(all, kSection);
  RigParameters loaded = parameters;
  loaded.visit(loader);
  const Failure failure = loader.finish();
  if (!failure) parameters = loaded;
  return failure;
}

template Failure loadParameters(const ros::NodeHandle&, const std::string&, RectifyParameters&,
                                NodeParameters&);
template Failure loadParameters(const ros::NodeHandle&, const std::string&, StereoDepthParameters&,
                                NodeParameters&);
template Failure loadParameters(const ros::NodeHandle&, const std::string&, ApproachAngleParameters&,
                                NodeParameters&);
template Failure loadParameters(const ros::NodeHandle&, const std::string&, KalmanHeightParameters&,
                                NodeParameters&);
template Failure loadParameters(const ros::NodeHandle&, const std::string&, OverlayParameters&,
                                NodeParameters&);
template Failure loadParameters(const ros::NodeHandle&, const std::string&, AutopilotParameters&,
                                NodeParameters&);

}  // namespace uav_landing
