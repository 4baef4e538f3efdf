#pragma once
// Mathematical and physical constants, and the conversions of units that names in this project carry.

#include <numbers>

namespace patina {

inline constexpr double pi = std::numbers::pi;
inline constexpr double degrees_per_radian = 180.0 / pi;

constexpr double radians(double degrees) {
    return degrees / degrees_per_radian;
}
constexpr double degrees(double radians) {
    return radians * degrees_per_radian;
}

}  // namespace patina
