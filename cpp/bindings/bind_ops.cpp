// The op list, for the proofs: photograd._core.ops is {name: Op}, each with flat forward, backward,
// jvp.
#include <pybind11/stl.h>

#include "array_args.h"
#include "bindings/op_adapters/op_list.h"
#include "module.h"
#include "photograd/core/real.h"

namespace photograd {
namespace {

template <class Op>
constexpr int input_count() {
    int n = 0;
    for (const InputGroup& group : Op::inputs) n += group.size;
    return n;
}

struct OpInfo {
    std::string name;
    std::vector<std::tuple<std::string, int, double, double>> inputs;
    int outputs;
    py::array (*forward)(const py::array&);
    py::array (*backward)(const py::array&, const py::array&, py::array);
    py::array (*jvp)(const py::array&, const py::array&);
};

template <class Op>
py::array op_forward(const py::array& x) {
    return dispatch_real(Op::name, "x", x, [&](auto real, ArrayArgs& args) -> py::array {
        using R = decltype(real);
        const R* in = args.in<R>("x", x, "I");
        if (args.size("I") != input_count<Op>())
            args.range("x", std::to_string(input_count<Op>()) + " inputs",
                       std::to_string(args.size("I")));
        py::array_t<R> y = zeros<R>({Op::outputs});
        Op::forward(in, y.mutable_data());
        return y;
    });
}

template <class Op>
py::array op_backward(const py::array& x, const py::array& d_y, py::array d_x) {
    return dispatch_real(Op::name, "x", x, [&](auto real, ArrayArgs&) -> py::array {
        using R = decltype(real);
        ArrayArgs args(std::string(Op::name) + "_backward");
        const R* in = args.in<R>("x", x, "I");
        const R* d_out = args.in<R>("d_y", d_y, "O");
        R* d_in = args.out<R>("d_x", d_x, "I");
        if (args.size("I") != input_count<Op>() || args.size("O") != Op::outputs)
            args.range("x, d_y", "the sizes of the op", "others");
        Op::backward(in, d_out, d_in);
        return d_x;
    });
}

template <class Op>
py::array op_jvp(const py::array& x, const py::array& v) {
    using D = Dual<double>;
    ArrayArgs args(std::string(Op::name) + "_jvp");
    const double* in = args.in<double>("x", x, "I");
    const double* tangent = args.in<double>("v", v, "I");
    std::array<D, input_count<Op>()> dual;
    if (args.size("I") != input_count<Op>())
        args.range("x", std::to_string(input_count<Op>()) + " inputs",
                   std::to_string(args.size("I")));
    for (std::size_t i = 0; i < dual.size(); ++i) dual[i] = D(in[i], tangent[i]);
    std::array<D, Op::outputs> out;
    Op::forward(dual.data(), out.data());
    py::array_t<double> jv(Op::outputs);
    for (int i = 0; i < Op::outputs; ++i)
        jv.mutable_data()[i] = out[static_cast<std::size_t>(i)].tangent;
    return jv;
}

}  // namespace

void bind_ops(py::module_& m) {
    py::class_<OpInfo>(m, "Op", "A differentiable op as a flat function, for the proofs.")
        .def_readonly("name", &OpInfo::name)
        .def_readonly("inputs", &OpInfo::inputs, "Differentiable groups: (name, size, lo, hi).")
        .def_readonly("outputs", &OpInfo::outputs)
        .def(
            "forward", [](const OpInfo& op, const py::array& x) { return op.forward(x); },
            py::arg("x"), "y of the flat inputs x, in float32 or float64.")
        .def(
            "backward",
            [](const OpInfo& op, const py::array& x, const py::array& d_y, py::array d_x) {
                return op.backward(x, d_y, std::move(d_x));
            },
            py::arg("x"), py::arg("d_y"), py::arg("d_x"), "Adds J^T d_y to d_x and returns it.")
        .def(
            "jvp",
            [](const OpInfo& op, const py::array& x, const py::array& v) { return op.jvp(x, v); },
            py::arg("x"), py::arg("v"), "J v, exactly, by dual numbers (float64).");
    py::dict ops;
    Ops::for_each([&]<class Op>(std::type_identity<Op>) {
        OpInfo info{Op::name, {}, Op::outputs, &op_forward<Op>, &op_backward<Op>, &op_jvp<Op>};
        for (const InputGroup& g : Op::inputs) info.inputs.emplace_back(g.name, g.size, g.lo, g.hi);
        ops[Op::name] = py::cast(info);
    });
    m.attr("ops") = ops;
}

}  // namespace photograd
