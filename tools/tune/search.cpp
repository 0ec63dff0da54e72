#include "search.h"

#include <limits>

#include <nlopt.hpp>

namespace obscura::tune {

namespace {

struct State {
    const std::function<Answer(const std::vector<double>&)>& evaluate;
    uint32_t spent = 0, calls = 0, limit = 0;
    double best = std::numeric_limits<double>::infinity();
    std::vector<double> at;

    double ask(const std::vector<double>& point) {
        constexpr uint32_t kCallsEach = 40;  // rounding maps many points to one; a search without new points ends after so many calls
        if (spent >= limit || ++calls > kCallsEach * limit) throw nlopt::forced_stop();
        const Answer answer = evaluate(point);
        spent += answer.fresh;
        if (answer.value < best) best = answer.value, at = point;
        return answer.value;
    }
};

double call(const std::vector<double>& point, std::vector<double>&, void* state) { return static_cast<State*>(state)->ask(point); }

void run(nlopt::algorithm algorithm, State& state, uint32_t limit) {
    nlopt::opt opt(algorithm, unsigned(state.at.size()));
    opt.set_lower_bounds(0.0);
    opt.set_upper_bounds(1.0);
    opt.set_min_objective(call, &state);
    opt.set_xtol_abs(1e-3);
    opt.set_initial_step(0.15);
    state.limit = limit;
    state.calls = 0;
    std::vector<double> point = state.at;
    double value = 0.0;
    try {
        opt.optimize(point, value);
    } catch (const nlopt::forced_stop&) {        // evaluations used up
    } catch (const nlopt::roundoff_limited&) {}  // precision exhausted: keep the best point
}

}  // namespace

std::vector<double> search(const std::vector<double>& start, uint32_t evaluations, uint32_t seed,
    const std::function<Answer(const std::vector<double>&)>& evaluate) {
    nlopt::srand(seed);
    State state{evaluate, 0, 0, evaluations, std::numeric_limits<double>::infinity(), start};
    state.ask(start);
    run(nlopt::GN_DIRECT_L_RAND, state, evaluations / 2);
    run(nlopt::LN_SBPLX, state, evaluations);
    return state.at;
}

}  // namespace obscura::tune
