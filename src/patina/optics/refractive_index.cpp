#include "patina/optics/refractive_index.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "patina/core/contract.h"
#include "patina/core/error.h"

namespace patina::optics {

OpticalConstants::OpticalConstants(std::string name, std::string citation, double wavelength_min_nm,
                                   double wavelength_max_nm, bool k_known,
                                   std::function<std::complex<double>(double)> index)
    : name_(std::move(name)),
      citation_(std::move(citation)),
      wavelength_min_nm_(wavelength_min_nm),
      wavelength_max_nm_(wavelength_max_nm),
      k_known_(k_known),
      index_(std::move(index)) {
    PATINA_EXPECT(wavelength_min_nm_ >= 0.0 && wavelength_min_nm_ <= wavelength_max_nm_);
    PATINA_EXPECT(index_ != nullptr);
}

OpticalConstants OpticalConstants::constant(std::complex<double> index) {
    PATINA_EXPECT(index.real() > 0.0 && index.imag() >= 0.0);
    return OpticalConstants(fmt::format("{} + {} i", index.real(), index.imag()), "given as a number", 0.0,
                            std::numeric_limits<double>::infinity(), true, [index](double) { return index; });
}

std::complex<double> OpticalConstants::at(double wavelength_nm, Extrapolation extrapolation) const {
    if (covers(wavelength_nm)) return index_(wavelength_nm);
    if (extrapolation == Extrapolation::hold && wavelength_nm > 0.0)
        return index_(std::clamp(wavelength_nm, wavelength_min_nm_, wavelength_max_nm_));
    throw input_error({}, fmt::format("no optical constants of {} at {} nm", name_, wavelength_nm),
                      fmt::format("its data reach from {:g} to {:g} nm: {}", wavelength_min_nm_, wavelength_max_nm_,
                                  citation_.empty() ? "no publication named" : citation_),
                      "stay inside that range, ask for extrapolation, or bring other data");
}

}  // namespace patina::optics
