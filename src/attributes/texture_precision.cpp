// SPDX-License-Identifier: MIT
#include "meshbound/attributes.h"
#include "numeric/rounded_to_float.h"

namespace meshbound {

TextureCoordinate rounded_to(TexturePrecision precision, const TextureCoordinate& coordinate) {
  const double u = coordinate.x(), v = coordinate.y();
  switch (precision) {
    case TexturePrecision::Double:
      return coordinate;
    case TexturePrecision::Float:
      return {rounded_to_float(u), rounded_to_float(v)};
    case TexturePrecision::FloatFromTop:
      break;
  }
  return {rounded_to_float(u), 1 - rounded_to_float(1 - v)};
}

}  // namespace meshbound
