// Shapes of networks and encodings, as the bindings of networks and of neural fields have them.
#pragma once

#include "array_args.h"
#include "photograd/network/hash_encoding.h"
#include "photograd/network/shape.h"

namespace photograd {

/// Levels, features and interpolation of a hash encoding, of 2 or 3 dimensions.
struct HashSettings {
    std::vector<HashLevel> levels;
    int dimensions, features;
    bool smoothstep;

    [[nodiscard]] std::int64_t rows() const { return levels.back().first + levels.back().rows; }
    [[nodiscard]] std::string table_axes() const {
        return std::to_string(rows()) + " " + std::to_string(features);
    }
};

template <class R>
const R* network_parameters(ArrayArgs& args, const char* name, const PerceptronShape& shape,
                            const py::array& array) {
    return args.in<R>(name, array, std::to_string(shape.parameters()));
}

}  // namespace photograd
