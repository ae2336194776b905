// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "accessor.hpp"

#include <algorithm>
#include <cstring>

namespace vsplit::bake {
namespace {

Error malformed(const std::string& name, const std::string& what) {
    return {ErrorCode::kMalformed, name + ": " + what, Error::kNowhere, 0};
}

/// 0 for what glTF 2.0 does not have; tinygltf lets 32-bit signed integers and doubles through.
std::uint64_t component_size(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

bool index_type(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

std::uint32_t load_index(const std::byte* at, int type) {
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return load<std::uint8_t>(at);
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<std::uint16_t>(at);
    return load<std::uint32_t>(at);
}

/// glTF 2.0, section 3.6.2.2; the lowest signed value is clamped to -1.
float load_component(const std::byte* at, int type, bool normalised) {
    const auto scaled = [&](double value, double max) {
        return static_cast<float>(normalised ? std::max(value / max, -1.0) : value);
    };
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return scaled(load<std::int8_t>(at), 127);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return scaled(load<std::uint8_t>(at), 255);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return scaled(load<std::int16_t>(at), 32767);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return scaled(load<std::uint16_t>(at), 65535);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return scaled(load<std::uint32_t>(at), 4294967295.0);
        default:
            return load<float>(at);
    }
}

/// `count` elements of `size` bytes every `stride` from `offset` on lie within `length` bytes.
bool fits(std::uint64_t length, std::uint64_t offset, std::uint64_t count, std::uint64_t stride,
          std::uint64_t size) {
    if (count == 0) return true;
    if (offset > length || size > length - offset) return false;
    return (length - offset - size) / stride >= count - 1;
}

}  // namespace

Result<AccessorReader> AccessorReader::open(Document& document, int accessor, const std::string& name) {
    const tinygltf::Accessor& source = document.model.accessors[static_cast<std::size_t>(accessor)];
    const std::string here = name + " (" + object_name("accessors", static_cast<std::size_t>(accessor)) + ")";
    AccessorReader out;
    out.type_ = source.componentType;
    out.normalised_ = source.normalized;
    out.count_ = source.count;
    const std::uint64_t bytes = component_size(out.type_);
    if (bytes == 0)
        return malformed(here, "component type " + std::to_string(out.type_) + " is not one of glTF's");
    out.shape_ = source.type;
    int columns = 1;
    switch (source.type) {
        case TINYGLTF_TYPE_SCALAR:
            out.rows_ = 1;
            break;
        case TINYGLTF_TYPE_VEC2:
            out.rows_ = 2;
            break;
        case TINYGLTF_TYPE_VEC3:
            out.rows_ = 3;
            break;
        case TINYGLTF_TYPE_VEC4:
            out.rows_ = 4;
            break;
        case TINYGLTF_TYPE_MAT2:
            out.rows_ = columns = 2;
            break;
        case TINYGLTF_TYPE_MAT3:
            out.rows_ = columns = 3;
            break;
        case TINYGLTF_TYPE_MAT4:
            out.rows_ = columns = 4;
            break;
        default:
            return malformed(here, "its type is not one of glTF's");
    }
    out.components_ = out.rows_ * columns;
    // Columns of matrices begin at multiples of four bytes (glTF 2.0, section 3.6.2.4).
    out.column_ = bytes * static_cast<std::uint64_t>(out.rows_);
    if (columns > 1) out.column_ = (out.column_ + 3) / 4 * 4;
    out.size_ = out.column_ * static_cast<std::uint64_t>(columns);
    if (out.count_ == 0) return malformed(here, "no elements");
    if (source.bufferView >= 0) {
        const auto number = static_cast<std::size_t>(source.bufferView);
        const auto view = document.view(number);
        if (!view.ok()) return malformed(here, view.error().message);
        const auto compressed = document.meshopt.find(number);
        const std::uint64_t stride = compressed != document.meshopt.end()
                                         ? compressed->second.stride
                                         : document.model.bufferViews[number].byteStride;
        out.stride_ = stride == 0 ? out.size_ : stride;
        if (out.stride_ < out.size_)
            return malformed(here, "a stride of " + std::to_string(out.stride_) + " for elements of " +
                                       std::to_string(out.size_) + " bytes");
        if (!fits(view->size(), source.byteOffset, out.count_, out.stride_, out.size_))
            return malformed(here, std::to_string(out.count_) + " elements do not fit into the " +
                                       std::to_string(view->size()) + " bytes of " +
                                       object_name("bufferViews", number));
        out.base_ = view->data() + source.byteOffset;
    } else if (out.count_ > document.total_bytes() + 1024) {
        // Zeros take no bytes in the file, so nothing else bounds their number.
        return Error{ErrorCode::kLimit,
                     here + ": " + std::to_string(out.count_) + " elements that are stored nowhere",
                     Error::kNowhere, 0};
    }
    if (!source.sparse.isSparse) return out;

    const auto& sparse = source.sparse;
    const auto part = [&](int view_number, int offset, std::uint64_t size) -> Result<const std::byte*> {
        const auto view = document.view(static_cast<std::size_t>(view_number));
        if (!view.ok()) return malformed(here, view.error().message);
        if (offset < 0 ||
            !fits(view->size(), static_cast<std::uint64_t>(offset), out.sparse_count_, size, size))
            return malformed(here, "its sparse part does not fit into " +
                                       object_name("bufferViews", static_cast<std::size_t>(view_number)));
        return view->data() + offset;
    };
    if (sparse.count < 0 || static_cast<std::uint64_t>(sparse.count) > out.count_)
        return malformed(here, "more sparse elements than elements");
    if (!index_type(sparse.indices.componentType))
        return malformed(here, "its sparse indices are not unsigned integers");
    out.sparse_count_ = static_cast<std::uint64_t>(sparse.count);
    out.sparse_type_ = sparse.indices.componentType;
    const auto indices =
        part(sparse.indices.bufferView, sparse.indices.byteOffset, component_size(out.sparse_type_));
    if (!indices.ok()) return indices.error();
    const auto values = part(sparse.values.bufferView, sparse.values.byteOffset, out.size_);
    if (!values.ok()) return values.error();
    out.sparse_indices_ = *indices;
    out.sparse_values_ = *values;
    std::uint64_t least = 0;
    for (std::uint64_t i = 0; i < out.sparse_count_; ++i) {
        const std::uint64_t index =
            load_index(out.sparse_indices_ + i * component_size(out.sparse_type_), out.sparse_type_);
        if (index < least || index >= out.count_)
            return malformed(here, "its sparse indices are out of order or range");
        least = index + 1;
    }
    return out;
}

const std::byte* AccessorReader::element(std::uint64_t i) const {
    if (sparse_count_ > 0) {
        const std::uint64_t size = component_size(sparse_type_);
        std::uint64_t low = 0, high = sparse_count_;
        while (low < high) {
            const std::uint64_t middle = (low + high) / 2;
            if (load_index(sparse_indices_ + middle * size, sparse_type_) < i)
                low = middle + 1;
            else
                high = middle;
        }
        if (low < sparse_count_ && load_index(sparse_indices_ + low * size, sparse_type_) == i)
            return sparse_values_ + low * size_;
    }
    static constexpr std::byte zeros[64] = {};
    return base_ == nullptr ? zeros : base_ + i * stride_;
}

void AccessorReader::read(std::uint64_t i, std::span<float> out) const {
    const std::byte* at = element(i);
    const std::uint64_t size = component_size(type_), rows = static_cast<std::uint64_t>(rows_);
    for (std::uint64_t c = 0; c < out.size(); ++c)
        out[c] = load_component(at + c / rows * column_ + c % rows * size, type_, normalised_);
}

std::uint32_t AccessorReader::integer(std::uint64_t i, std::uint64_t c) const {
    return load_index(element(i) + c * component_size(type_), type_);
}

std::uint32_t AccessorReader::index(std::uint64_t i) const {
    return load_index(element(i), type_);
}

}  // namespace vsplit::bake
