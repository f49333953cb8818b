/// \file
/// minamo with two more systems: one measures the mean height of the fluid, one prints it.

#include <minamo/minamo.hpp>

#include <minamo/components/particle.hpp>
#include <minamo/engine/run/clock.hpp>
#include <minamo/engine/schedule/system.hpp>

#include <cstdio>

/// Height of the centre of mass. [m]
struct MeanHeight {
  double value = 0;
  static constexpr minamo::ComponentInfo info{"mean_height", "h", "m", minamo::Lifetime::scratch};
};

/// h = sum_p m_p y_p / sum_p m_p.
template <int Dim>
struct MeasureMeanHeight {
  static constexpr const char* doc = "h = sum_p m_p y_p / sum_p m_p";

  void operator()(minamo::Read<minamo::particle::Mass> m_p, minamo::Read<minamo::particle::Position<Dim>> x_p,
                  minamo::Write<MeanHeight> h) const {
    double mass = 0;
    double moment = 0;
    for (std::size_t p = 0; p < m_p.size(); ++p) {
      mass += m_p[p];
      moment += m_p[p] * x_p[p][1];
    }
    h->value = moment / mass;
  }
};

/// It reads what the other one writes, and so runs after it.
template <int Dim>
struct LogMeanHeight {
  static constexpr const char* doc = "prints time and mean height";

  void operator()(minamo::Read<minamo::Clock> clock, minamo::Read<MeanHeight> h) const {
    std::printf("step from t = %.4f s: mean height %.6f m\n", clock->time, h->value);
  }
};

int main(int argc, char** argv) {
  return minamo::run(argc, argv, [](minamo::SystemRegistry& registry) {
    registry.add<MeasureMeanHeight>("mean_height");
    registry.add<LogMeanHeight>("log_mean_height");
  });
}
