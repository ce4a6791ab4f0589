#pragma once

#include <ros/serialization.h>
#include <rosbag/exceptions.h>
#include <rosbag/message_instance.h>

#include <boost/make_shared.hpp>
#include <memory>
#include <string>
#include <vector>

namespace uav_landing {

/// Bytes of a message, for roscpp to read from. roscpp takes as much memory as the length of a text or
/// sequence says, which may be gigabytes. So each length is first compared with the bytes that are left.
/// Throws ros::serialization::StreamOverrunException.
class MessageBytes : public ros::serialization::Stream {
 public:
  static constexpr ros::serialization::StreamType stream_type = ros::serialization::stream_types::Input;
  MessageBytes(uint8_t* bytes, uint32_t size) : Stream(bytes, size) {}

  // Called by the serialisers.
  template <class T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }
  void next(std::string& text) {
    expectFitting(1);
    ros::serialization::deserialize(*this, text);
  }
  template <class Element, class Allocator>
  void next(std::vector<Element, Allocator>& elements) {
    const bool fixed = ros::message_traits::isFixedSize<Element>();
    expectFitting(fixed ? ros::serialization::serializationLength(Element()) : 1);
    ros::serialization::deserialize(*this, elements);
  }

 private:
  void expectFitting(uint64_t element) {
    MessageBytes ahead = *this;
    uint32_t count = 0;
    ahead.next(count);
    if (count * element > ahead.getLength()) ros::serialization::throwStreamOverrun();
  }
};

/// The message; null when it has another type than T or another version of it. Throws
/// rosbag::BagFormatException when it is damaged.
template <class T>
boost::shared_ptr<T> readMessage(const rosbag::MessageInstance& message) {
  if (!message.isType<T>()) return {};
  const uint32_t size = message.size();
  const std::unique_ptr<uint8_t[]> bytes(new uint8_t[size]);
  ros::serialization::OStream copy(bytes.get(), size);
  message.write(copy);
  const auto read = boost::make_shared<T>();
  try {
    MessageBytes(bytes.get(), size).next(*read);
  } catch (const ros::serialization::StreamOverrunException&) {
    throw rosbag::BagFormatException("a message of " + message.getTopic() + " has " + std::to_string(size) +
                                     " bytes, fewer than the lengths in it say");
  }
  return read;
}

}  // namespace uav_landing
