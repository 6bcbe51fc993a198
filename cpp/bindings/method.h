// Member functions as methods in Python that refuse None for self.
#pragma once

#include <utility>

namespace photograd {

/// A const member function of T, or of a base, as a function on a reference. pybind11 passes self
/// of member functions as a pointer, which None makes null.
template <class T, class Base, class Result, class... Args>
auto method(Result (Base::*member)(Args...) const) {
    return [member](const T& self, Args... args) -> Result {
        return (self.*member)(std::forward<Args>(args)...);
    };
}

}  // namespace photograd
