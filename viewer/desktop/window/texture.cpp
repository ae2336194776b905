// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "texture.hpp"

#include <vtkImageData.h>
#include <vtkImageReader2.h>
#include <vtkJPEGReader.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <cstring>

namespace vsplit::studio {
namespace {

constexpr std::int64_t kMostPixels = std::int64_t{1} << 26;

Image read(vtkImageReader2* reader, std::span<const std::byte> bytes) {
    reader->SetMemoryBuffer(bytes.data());
    reader->SetMemoryBufferLength(vtkIdType(bytes.size()));
    reader->UpdateInformation();
    const int* extent = reader->GetDataExtent();
    const std::int64_t width = std::int64_t{extent[1]} - extent[0] + 1,
                       height = std::int64_t{extent[3]} - extent[2] + 1;
    if (width < 1 || height < 1 || width > kMostPixels / height) return {};
    reader->Update();
    vtkImageData* data = reader->GetOutput();
    const int components = data->GetNumberOfScalarComponents();
    if (data->GetScalarType() != VTK_UNSIGNED_CHAR && data->GetScalarType() != VTK_UNSIGNED_SHORT) return {};
    Image image{int(width), int(height), {}};
    image.pixels.resize(std::size_t(width * height));
    const bool wide = data->GetScalarType() == VTK_UNSIGNED_SHORT;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            // VTK's rows go up.
            const void* from = data->GetScalarPointer(extent[0] + x, extent[3] - y, extent[4]);
            if (!from) return {};
            auto& pixel = image.pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
            for (int c = 0; c < 3; ++c) {
                const int k = components < 3 ? 0 : c;
                pixel[std::size_t(c)] = wide ? std::uint8_t(static_cast<const std::uint16_t*>(from)[k] >> 8)
                                             : static_cast<const std::uint8_t*>(from)[k];
            }
        }
    return image;
}

}  // namespace

Image decode_image(std::span<const std::byte> bytes) {
    const auto begins = [&](const char* magic, std::size_t count) {
        return bytes.size() > count && std::memcmp(bytes.data(), magic, count) == 0;
    };
    // A damaged image is no reason to fill the terminal.
    const bool warnings = vtkObject::GetGlobalWarningDisplay() != 0;
    vtkObject::GlobalWarningDisplayOff();
    Image image;
    if (begins("\x89PNG", 4)) {
        vtkNew<vtkPNGReader> reader;
        image = read(reader, bytes);
    } else if (begins("\xFF\xD8\xFF", 3)) {
        vtkNew<vtkJPEGReader> reader;
        image = read(reader, bytes);
    }
    vtkObject::SetGlobalWarningDisplay(warnings);
    return image;
}

}  // namespace vsplit::studio
