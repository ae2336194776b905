// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "transforms.hpp"

#include <algorithm>
#include <cmath>

namespace vsplit::bake {

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t k = 0; k < 4; ++k) out[column * 4 + row] += a[k * 4 + row] * b[column * 4 + k];
    return out;
}

double determinant(const Matrix& m) {
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
           m[8] * (m[1] * m[6] - m[5] * m[2]);
}

Matrix local_matrix(const tinygltf::Node& node) {
    Matrix out = kIdentity;
    if (node.matrix.size() == 16) {
        std::copy(node.matrix.begin(), node.matrix.end(), out.begin());
        out[3] = out[7] = out[11] = 0;
        out[15] = 1;
        return out;
    }
    if (node.rotation.size() == 4) {
        double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2], w = node.rotation[3];
        // Files round quaternions to single precision; without this a deep tree would scale.
        if (const double length = std::sqrt(x * x + y * y + z * z + w * w);
            length > 0 && std::isfinite(length))
            x /= length, y /= length, z /= length, w /= length;
        out = {1 - 2 * (y * y + z * z),
               2 * (x * y + z * w),
               2 * (x * z - y * w),
               0,
               2 * (x * y - z * w),
               1 - 2 * (x * x + z * z),
               2 * (y * z + x * w),
               0,
               2 * (x * z + y * w),
               2 * (y * z - x * w),
               1 - 2 * (x * x + y * y),
               0,
               0,
               0,
               0,
               1};
    }
    if (node.scale.size() == 3)
        for (std::size_t column = 0; column < 3; ++column)
            for (std::size_t row = 0; row < 3; ++row) out[column * 4 + row] *= node.scale[column];
    if (node.translation.size() == 3)
        std::copy(node.translation.begin(), node.translation.end(), out.begin() + 12);
    return out;
}

double largest_scale(const Matrix& m) {
    double most = 0;
    for (std::size_t column = 0; column < 3; ++column) {
        const double x = m[column * 4], y = m[column * 4 + 1], z = m[column * 4 + 2];
        most = std::max(most, std::sqrt(x * x + y * y + z * z));
    }
    return most;
}

}  // namespace vsplit::bake
