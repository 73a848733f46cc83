// Random variates with fixed algorithms: the same stream gives the same noise on every machine.
#ifndef EYEBOX_CAPTURE_CAMERA_SIM_NOISE_H_
#define EYEBOX_CAPTURE_CAMERA_SIM_NOISE_H_

#include <cstdint>
#include <initializer_list>

#include "capture/base/random.h"

namespace eyebox::capture {

class NoiseSource {
 public:
  explicit NoiseSource(std::initializer_list<uint64_t> key) : stream_(key) {}

  double Uniform() { return stream_.Uniform(); }

  // Mean 0, standard deviation 1 (Box & Muller 1958).
  double Gaussian();

  // Events of a Poisson process of this mean, >= 0 and below 1e15: multiplication of uniforms
  // below a mean of 10, transformed rejection PTRS above (Hoermann 1993).
  int64_t Poisson(double mean);

 private:
  RandomStream stream_;
  double spare_ = 0;
  bool has_spare_ = false;
};

// ln(k!), k >= 0, to 1e-10 absolute or better than 1e-15 relative.
double LogFactorial(double k);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_SIM_NOISE_H_
