#include "kernels/samples/surface_places.h"

#include "kernels/lanes/lanes.h"
#include "kernels/lanes/multiversion.h"

namespace uav_landing {

UAV_LANDING_MULTIVERSION void placeOnSurface(const LinearValue& plane, const LinearValue& reach, double scale,
                                             double least, const SurfaceColumns& columns) {
  const double gx = plane.x_slope, gy = plane.y_slope, gz = plane.constant;
  const double rx = reach.x_slope, ry = reach.y_slope, rz = reach.constant;
  const DoubleLanes lowest = DoubleLanes{} + least;
  for (size_t i = 0; i < columns.count; i += kDoubleLanes) {
    DoubleLanes x, y, value, flat;
    load(columns.x + i, x);
    load(columns.y + i, y);
    load(columns.value + i, value);
    load(columns.flat + i, flat);
    const DoubleLanes by_plane = scale * (gx * x + gy * y + gz), on_surface = by_plane + (value - flat);
    store(by_plane, columns.by_plane + i);
    store(on_surface < lowest ? lowest : on_surface, columns.expected + i);
    store(scale * (rx * x + ry * y + rz), columns.reach + i);
  }
}

}  // namespace uav_landing
