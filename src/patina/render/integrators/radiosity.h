#pragma once
// `radiosity`: the diffuse scene as a discrete linear system B = E + rho F B, Goral et al. (1984).
//
// Form factors F by ray casting (Malley's method): each patch sends rays distributed by the cosine, and the share that
// another patch receives is the form factor; rows add up to one where the scene is closed, exactly. Point, directional
// and infinite lights give every patch an irradiance besides. The system is solved at every 20 nm by LU factorization
// or by Jacobi's, Gauss' and Seidel's or Neumann's iteration (for patches that do not see themselves the first and the
// last are the same). The picture takes direct light at each point and gathers the rest from the patches (Reichert
// 1992), or, with gather = false, shows the patches. There is no polarization: every surface depolarizes, and
// interreflections of all orders are in.

#include <map>
#include <optional>
#include <vector>

#include "patina/render/integrators/integrator.h"
#include "patina/render/integrators/radiosity_patches.h"

namespace patina::render {

class RadiosityIntegrator final : public Integrator {
  public:
    enum class Solver { lu, jacobi, gauss_seidel, neumann };
    struct Settings {
        int patches = 600;
        int rays = 1024;  // from each patch, for its form factors
        Solver solver = Solver::lu;
        bool gather = true;
        bool hide_emitters = false;
    };
    explicit RadiosityIntegrator(const Settings& settings) : settings_(settings) {}

    void prepare(const TransportProblem& problem, const JobControl& control) override;
    void trace(const TransportProblem& problem, const Sensor::CameraRay& camera, const Wavelengths& wavelengths,
               Sampler& sampler, PathRecord& record) const override;
    bool knows_paths() const override { return false; }
    std::map<std::string, std::string> notes() const override { return notes_; }

  private:
    struct Row;  // what a patch's rays found
    Row cast_rays(const TransportProblem& problem, int patch) const;
    Eigen::VectorXd solve(const Eigen::VectorXd& reflectance, const Eigen::VectorXd& irradiance,
                          const Eigen::VectorXd& emission);
    Eigen::VectorXd iterate(const Eigen::VectorXd& reflectance, const Eigen::VectorXd& source);
    // Radiance that a patch reflects.
    Float4 reflected(int patch, const Wavelengths& w) const;

    Settings settings_;
    std::optional<RadiosityPatches> patches_;
    Eigen::MatrixXd form_factors_;
    std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> factorization_;
    Eigen::VectorXd factored_reflectance_;
    std::vector<float> radiance_;  // [patch][wavelength node]
    int iterations_ = 0;
    std::map<std::string, std::string> notes_;
};

}  // namespace patina::render
