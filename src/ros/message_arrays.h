#pragma once

namespace uav_landing {

// Copies vectors and matrices of results to the arrays of messages and back, row major.

template <class Vector, class Array>
void toArray(const Vector& vector, Array& array) {
  for (int row = 0, i = 0; row < vector.rows(); ++row)
    for (int column = 0; column < vector.cols(); ++column) array[i++] = vector(row, column);
}

template <class Array, class Vector>
void fromArray(const Array& array, Vector& vector) {
  for (int row = 0, i = 0; row < vector.rows(); ++row)
    for (int column = 0; column < vector.cols(); ++column) vector(row, column) = array[i++];
}

}  // namespace uav_landing
