// The op list, for the proofs: photograd._core.ops is {name: Op}, each with flat forward, backward,
// jvp.

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

/// An op whose arrays are as long as `inputs` and `outputs` say.
struct OpInfo {
    std::string name;
    std::vector<std::tuple<std::string, int, double, double>> inputs;
    int input_count, outputs;
    std::tuple<void (*)(const float*, float*), void (*)(const double*, double*)> forward;
    std::tuple<void (*)(const float*, const float*, float*),
               void (*)(const double*, const double*, double*)>
        backward;
    void (*jvp)(const double* x, const double* v, double* Jv);

    /// The array `x` of inputs.
    template <class R>
    const R* flat(ArrayArgs& args, const char* argument, const py::array& x) const {
        const R* in = args.in<R>(argument, x, "I");
        if (args.size("I") != input_count)
            args.range(argument, std::to_string(input_count) + " inputs",
                       std::to_string(args.size("I")));
        return in;
    }
};

template <class Op>
void op_jvp(const double* x, const double* v, double* Jv) {
    using D = Dual<double>;
    std::array<D, input_count<Op>()> dual;
    for (std::size_t i = 0; i < dual.size(); ++i) dual[i] = D(x[i], v[i]);
    std::array<D, Op::outputs> out;
    Op::forward(dual.data(), out.data());
    for (std::size_t i = 0; i < out.size(); ++i) Jv[i] = out[i].tangent;
}

py::array op_forward(const OpInfo& op, const py::array& x) {
    return dispatch_real(op.name.c_str(), "x", x, [&](auto real, ArrayArgs& args) -> py::array {
        using R = decltype(real);
        const R* in = op.flat<R>(args, "x", x);
        py::array_t<R> y = zeros<R>({op.outputs});
        std::get<void (*)(const R*, R*)>(op.forward)(in, y.mutable_data());
        return y;
    });
}

py::array op_backward(const OpInfo& op, const py::array& x, const py::array& d_y, py::array d_x) {
    const std::string function = op.name + "_backward";
    return dispatch_real(function.c_str(), "x", x, [&](auto real, ArrayArgs& args) -> py::array {
        using R = decltype(real);
        const R* in = op.flat<R>(args, "x", x);
        const R* d_out = args.in<R>("d_y", d_y, "O");
        R* d_in = args.out<R>("d_x", d_x, "I");
        if (args.size("O") != op.outputs)
            args.range("d_y", std::to_string(op.outputs) + " outputs",
                       std::to_string(args.size("O")));
        std::get<void (*)(const R*, const R*, R*)>(op.backward)(in, d_out, d_in);
        return d_x;
    });
}

py::array op_tangent(const OpInfo& op, const py::array& x, const py::array& v) {
    const std::string function = op.name + "_jvp";
    ArrayArgs args(function);
    const double* in = op.flat<double>(args, "x", x);
    const double* tangent = args.in<double>("v", v, "I");
    py::array_t<double> Jv(op.outputs);
    op.jvp(in, tangent, Jv.mutable_data());
    return Jv;
}

}  // namespace

void bind_ops(py::module_& m) {
    py::class_<OpInfo>(m, "Op", "A differentiable op as a flat function, for the proofs.")
        .def_readonly("name", &OpInfo::name)
        .def_readonly("inputs", &OpInfo::inputs, "Differentiable groups: (name, size, lo, hi).")
        .def_readonly("outputs", &OpInfo::outputs)
        .def("forward", &op_forward, py::arg("x"), "y of the flat inputs x, in float32 or float64.")
        .def("backward", &op_backward, py::arg("x"), py::arg("d_y"), py::arg("d_x"),
             "Adds J^T d_y to d_x and returns it.")
        .def("jvp", &op_tangent, py::arg("x"), py::arg("v"),
             "J v, exactly, by dual numbers (float64).");
    py::dict ops;
    Ops::for_each([&]<class Op>(std::type_identity<Op>) {
        OpInfo info{Op::name,
                    {},
                    input_count<Op>(),
                    Op::outputs,
                    {&Op::template forward<float>, &Op::template forward<double>},
                    {&Op::template backward<float>, &Op::template backward<double>},
                    &op_jvp<Op>};
        for (const InputGroup& g : Op::inputs) info.inputs.emplace_back(g.name, g.size, g.lo, g.hi);
        ops[Op::name] = py::cast(info);
    });
    m.attr("ops") = ops;
}

}  // namespace photograd
