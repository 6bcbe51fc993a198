// Typed errors. The Python classes are defined once, in photograd_course.errors, and
// bindings/errors.cpp raises the one that `kind` names. Core code throws; it never prints or exits.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace photograd {

enum class ErrorKind { error, shape, range, dtype, io, scene };

class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    [[nodiscard]] ErrorKind kind() const { return kind_; }

private:
    ErrorKind kind_;
};

/// The one form of a message: *function: argument: expected ..., got ... (what to do)*.
[[noreturn]] inline void fail(ErrorKind kind, std::string_view function, std::string_view argument,
                              std::string_view expected, std::string_view got,
                              std::string_view remedy = {}) {
    std::string text;
    text.append(function).append(": ").append(argument).append(": expected ").append(expected);
    text.append(", got ").append(got);
    if (!remedy.empty()) text.append(" (").append(remedy).append(")");
    throw Error(kind, text);
}

}  // namespace photograd
