#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace uav_landing {
namespace fuzz {

/// The bytes of one input, taken piece by piece; zeros when they have run out.
class Input {
 public:
  Input(const uint8_t* data, size_t size) : data_(data), left_(size) {}

  size_t left() const { return left_; }
  uint8_t byte() { return take<uint8_t>(); }
  /// 0 to count - 1.
  size_t choice(size_t count) { return byte() % count; }

  template <class T>
  T take() {
    T value{};
    const size_t size = std::min(left_, sizeof value);
    std::memcpy(&value, data_, size);
    data_ += size;
    left_ -= size;
    return value;
  }

  /// Mostly near to what is usual, else one of the numbers that break calculations, or any.
  double number(double usual) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double special[] = {0,   -0.0, -usual,    1,          -1,           1e-300,       1e300, -1e300,
                              1e9, 1e-9, kInfinity, -kInfinity, std::nan(""), 2147483648.0, 65536};
    const uint8_t kind = byte();
    if (kind < 128) return usual;
    if (kind < 200) return usual * (1 + 0.01 * (kind - 164));
    if (kind < 215) return special[kind - 200];
    return take<double>();
  }
  uint32_t count(uint32_t usual) {
    const uint8_t kind = byte();
    if (kind < 128) return usual;
    if (kind < 200) return usual + (kind - 164);
    return kind < 215 ? std::numeric_limits<uint32_t>::max() >> (kind - 200) : take<uint32_t>();
  }

  std::string text() { return bytes(byte()); }
  std::string rest() { return bytes(left_); }
  std::string bytes(size_t count) {
    const size_t size = std::min(left_, count);
    std::string taken(reinterpret_cast<const char*>(data_), size);
    data_ += size;
    left_ -= size;
    return taken;
  }

 private:
  const uint8_t* data_;
  size_t left_;
};

}  // namespace fuzz
}  // namespace uav_landing
