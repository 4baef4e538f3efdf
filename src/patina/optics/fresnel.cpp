#include "patina/optics/fresnel.h"

#include <algorithm>
#include <cmath>

#include "patina/core/contract.h"

namespace patina::optics {

namespace {

// The matrix of two amplitude factors acting on the p and s fields (Bohren & Huffman 1983, eq. 3.16 with S3 = S4 = 0).
Mueller mueller_of(Complex p, Complex s) {
    const double pp = std::norm(p), ss = std::norm(s);
    const Complex cross = p * std::conj(s);
    Mueller m = Mueller::Zero();
    m(0, 0) = m(1, 1) = 0.5 * (pp + ss);
    m(0, 1) = m(1, 0) = 0.5 * (pp - ss);
    m(2, 2) = m(3, 3) = cross.real();
    m(2, 3) = cross.imag();
    m(3, 2) = -cross.imag();
    return m;
}

}  // namespace

FresnelAmplitudes fresnel_amplitudes(double cos_i, Complex n1, Complex n2) {
    PATINA_EXPECT(cos_i >= 0.0 && cos_i <= 1.0);
    const Complex ratio = n1 / n2;

    // Choose the root whose wave decays into the second medium; written so that near grazing incidence nothing cancels.
    Complex cos_t = std::sqrt((n2 - n1) * (n2 + n1) / (n2 * n2) + ratio * ratio * (cos_i * cos_i));
    if ((n2 * cos_t).imag() < 0.0) cos_t = -cos_t;

    const Complex p = n2 * cos_i + n1 * cos_t;
    const Complex s = n1 * cos_i + n2 * cos_t;
    // Grazing incidence on a matched medium is 0/0; nothing is reflected there.
    if (std::abs(p) == 0.0 || std::abs(s) == 0.0) return {0.0, 0.0, 1.0, 1.0, cos_t};
    return {(n2 * cos_i - n1 * cos_t) / p, (n1 * cos_i - n2 * cos_t) / s, 2.0 * n1 * cos_i / p, 2.0 * n1 * cos_i / s,
            cos_t};
}

Mueller fresnel_reflection(double cos_i, Complex n1, Complex n2) {
    const FresnelAmplitudes f = fresnel_amplitudes(cos_i, n1, n2);
    return mueller_of(f.r_p, f.r_s);
}

Mueller fresnel_transmission(double cos_i, double n1, double n2) {
    const double cos_t = refracted_cosine(cos_i, n1, n2);
    if (cos_t == 0.0 || cos_i == 0.0) return Mueller::Zero();
    const FresnelAmplitudes f = fresnel_amplitudes(cos_i, n1, n2);
    return (n2 * cos_t) / (n1 * cos_i) * mueller_of(f.t_p, f.t_s);
}

double refracted_cosine(double cos_i, double n1, double n2) {
    const double ratio = n1 / n2;
    const double cos2_t = (n2 - n1) * (n2 + n1) / (n2 * n2) + ratio * ratio * cos_i * cos_i;
    // Rounding may carry the normal beyond itself.
    return cos2_t > 0.0 ? std::sqrt(std::min(cos2_t, 1.0)) : 0.0;
}

}  // namespace patina::optics
