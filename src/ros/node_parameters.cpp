#include "node_parameters.h"

#include <ros/param.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "autopilot_messages.h"
#include "parameter_names.h"
#include "parameters/section_loader.h"

namespace uav_landing {
namespace {

/// Converts a plain value. Lists and maps become an empty list, because no parameter is one. On the parameter
/// server they may also be nested without end.
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

/// Whether the parameter belongs to somebody else. Plugins of image_transport write theirs below the
/// nodelet's name as well. These are maps under the topic's name or their own, and they outlive the nodelet.
/// None of our parameters is a map.
bool isForeign(const std::string& section, const std::string& name, const XmlRpc::XmlRpcValue& value,
               const std::vector<std::string>& own) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeStruct &&
         std::find(own.begin(), own.end(), name) == own.end() && suggestName(name, own).empty() &&
         whereItBelongs(section, name).empty();
}

/// The values of a section on the parameter server, without those that skip(name, value) excludes. map: its
/// name there.
template <class Skip>
Expected<YAML::Node> readSection(const std::string& map, const std::string& section, Skip&& skip) {
  YAML::Node all(YAML::NodeType::Map);
  XmlRpc::XmlRpcValue given;
  if (!ros::param::get(map, given)) return all;
  if (given.getType() != XmlRpc::XmlRpcValue::TypeStruct)
    return tl::make_unexpected(
        Failure{Reason::kInputInvalid, section + ": expected a map of names and values"});
  for (auto& member : given)
    if (!skip(member.first, member.second)) all[member.first] = toYaml(member.second);
  return all;
}

/// Moves the keys of NodeParameters out of the map of all private parameters.
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
  const std::vector<std::string> names = parameterNames<NodeParameters, Section>();
  Expected<YAML::Node> all = readSection(
      private_handle.getNamespace(), section,
      [&](const std::string& name, const auto& value) { return isForeign(section, name, value, names); });
  if (!all) return all.error();
  NodeParameters loaded = node_parameters;
  const Failure failure = loadSection(takeNodeKeys(*all), section, loaded);
  if (failure) return failure;
  if (!loaded.config_file.empty()) {
    if (const auto file = loadParameterFile(loaded.config_file); !file) return file.error();
  }
  node_parameters = loaded;
  return loadSection(*all, section, parameters);
}

Failure loadSharedParameters(const ros::NodeHandle& handle, SharedParameters& parameters) {
  SharedParameters loaded = parameters;
  Failure failure;
  loaded.visitSections([&](const char* section, auto& values) {
    if (failure) return;
    const auto given = readSection(handle.resolveName(section), section, [](auto&&...) { return false; });
    failure = given ? loadSection(*given, section, values) : given.error();
  });
  if (!failure) parameters = loaded;
  return failure;
}

Failure resolveFiles(const NodeParameters& node_parameters, RigParameters& parameters) {
  if (!node_parameters.config_file.empty()) {
    resolveFiles(node_parameters.config_file, parameters);
    return {};
  }
  for (const auto& [name, file] :
       {std::pair("left_mask", &parameters.left_mask), {"right_mask", &parameters.right_mask}})
    if (!file->empty() && std::filesystem::path(*file).is_relative())
      return {Reason::kInputInvalid,
              std::string("rig/") + name + ": " + *file +
                  ": a relative path begins at the folder of config_file, which is not set; "
                  "give the full path"};
  return {};
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
