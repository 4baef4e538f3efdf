#include "patina/render/bsdf_checks.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "patina/brdf/physical_checks.h"
#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/render/bsdf_set.h"
#include "patina/render/random.h"

namespace patina::render {

namespace {

constexpr int wavelengths = 8, batches = 16, batch_samples = 256, matrix_samples = 32;

// Collects the worst of one law.
class Worst {
  public:
    Worst(std::string name, std::string explanation, double tolerance) {
        check_ = {std::move(name), std::move(explanation), 0, tolerance, 0, 0};
    }
    void note(double violation, const Wavelengths& w, const Vec3& view) {
        // What is no number is the worst of all.
        if (!std::isfinite(violation)) violation = INFINITY;
        if (violation <= check_.worst) return;
        check_.worst = violation;
        check_.wavelength_nm = w.nm[0];
        check_.theta_o_deg = degrees(std::acos(std::clamp(view.z(), -1.0f, 1.0f)));
    }
    const BsdfCheck& check() const { return check_; }

  private:
    BsdfCheck check_;
};

Vec3 direction(double theta_deg, double phi_deg) {
    const double s = std::sin(radians(theta_deg));
    return Vec3(s * std::cos(radians(phi_deg)), s * std::sin(radians(phi_deg)), std::cos(radians(theta_deg)));
}

class Examiner {
  public:
    Examiner(const Bsdf& bsdf, const std::vector<Bsdf>& set) : bsdf_(bsdf), set_(set) {}

    std::vector<BsdfCheck> run() {
        for (int k = 0; k < wavelengths; ++k) {
            const Wavelengths w = Wavelengths::sample((k + 0.5f) / wavelengths);
            int view = 0;
            for (double theta_deg : {0.0, 25.0, 50.0, 72.0, 85.0, 180.0, 155.0, 130.0, 108.0, 95.0})
                for (double phi_deg : {20.0, 250.0}) look(w, direction(theta_deg, phi_deg), view++);
        }
        return {energy_.check(), realizability_.check(), reciprocity_.check(), sampling_.check()};
    }

  private:
    // What white surroundings look like in the surface. The noise is that of the batches' means, of all four
    // components: where every draw is as bright as the next, what differs is which way it is polarized.
    void look(const Wavelengths& w, const Vec3& outgoing, int view) {
        Eigen::Vector4d mean = Eigen::Vector4d::Zero();
        double squares = 0;
        for (int batch = 0; batch < batches; ++batch) {
            const Eigen::Vector4d seen = batch_mean(w, outgoing, view, batch);
            mean += seen / batches;
            squares += seen.squaredNorm() / batches;
        }
        const double noise = std::sqrt(std::max(0.0, squares - mean.squaredNorm()) / (batches - 1));
        // Five standard errors: Student's 15 degrees of freedom, and 160 views a model.
        energy_.note(mean[0] + mean.tail<3>().norm() - 1 - 5 * noise, w, outgoing);
    }

    Eigen::Vector4d batch_mean(const Wavelengths& w, const Vec3& outgoing, int view, int batch) {
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        Vec3 x, y;
        orthonormal_basis(outgoing, x, y);
        for (int i = 0; i < batch_samples; ++i) {
            Sampler sampler(static_cast<std::uint32_t>(view * batches + batch), i, 17);
            const Vec2 uv = sampler.next2();
            const ShadingPoint point{&w, uv, set_.data()};
            BsdfSample s;
            const float lobe = sampler.next();
            if (!bsdf_sample(bsdf_, point, outgoing, lobe, sampler.next2(), s)) continue;
            const optics::Mueller m = s.weight.matrix(0);
            const double scale = static_cast<double>(s.eta) * s.eta;
            const bool turned = s.weight.form != ScatteringMatrix::Form::depolarizing;
            sum += scale * (turned ? Eigen::Vector4d(rotator(rotation_between(outgoing, s.weight.x_out, x)) * m.col(0))
                                   : Eigen::Vector4d(m.col(0)));
            if (batch == 0 && i < matrix_samples) examine(point, outgoing, s, m);
        }
        return sum / batch_samples;
    }

    void examine(const ShadingPoint& point, const Vec3& outgoing, const BsdfSample& s, const optics::Mueller& m) {
        const Wavelengths& w = *point.wavelengths;
        if (!m.allFinite() || m(0, 0) < 0) return realizability_.note(INFINITY, w, outgoing);
        if (m(0, 0) > 0) realizability_.note(-brdf::coherency_eigenvalues(m).minCoeff() / m(0, 0), w, outgoing);
        if (s.delta) return;
        BsdfValue forth, back;
        if (!bsdf_evaluate(bsdf_, point, outgoing, s.incident, forth)) return sampling_.note(1, w, outgoing);
        sampling_.note(std::abs(forth.pdf / s.pdf - 1), w, outgoing);

        // Light on its way back, where neither direction grazes.
        if (outgoing.z() * s.incident.z() < 0.01f) return;
        if (!bsdf_evaluate(bsdf_, point, s.incident, outgoing, back)) return reciprocity_.note(1, w, outgoing);
        const optics::Mueller f = forth.f.matrix(0) / std::abs(s.incident.z());
        optics::Mueller g = back.f.matrix(0) / std::abs(outgoing.z());
        if (forth.f.form != ScatteringMatrix::Form::depolarizing)
            g = rotate_frames(g, -outgoing, back.f.x_in, forth.f.x_out, s.incident, back.f.x_out, forth.f.x_in);
        const optics::Mueller expected = optics::reversal() * g.transpose() * optics::reversal();
        const double size = std::max(f(0, 0), g(0, 0));
        if (size > 0) reciprocity_.note((f - expected).norm() / size, w, outgoing);
    }

    const Bsdf& bsdf_;
    const std::vector<Bsdf>& set_;
    Worst energy_{"energy", "brightness above that of the surroundings, through the best polarizer", 0.01};
    Worst realizability_{"realizability", "negative eigenvalue of the coherency matrix over M00", 5e-3};
    Worst reciprocity_{"reciprocity", "difference from the reversed matrix over f00", 2e-2};
    Worst sampling_{"sampling", "drawn density against evaluated density, relative", 2e-2};
};

// All models of a tree, parents before children, each once.
void collect(const Properties& node, std::vector<const Properties*>& found, std::set<const Properties*>& seen) {
    for (const auto& child : node.children) {
        if (!seen.insert(child.node.get()).second) continue;
        if (child.node->category == "bsdf") found.push_back(child.node.get());
        collect(*child.node, found, seen);
    }
}

}  // namespace

bool BsdfReport::passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const BsdfCheck& check) { return check.passed(); });
}

std::vector<BsdfReport> check_bsdfs(const Properties& root, const SceneResources& resources) {
    std::vector<const Properties*> nodes;
    std::set<const Properties*> seen;
    collect(root, nodes, seen);
    std::vector<BsdfReport> reports;
    for (const Properties* node : nodes) {
        std::vector<Bsdf> set;
        std::map<std::string, std::string> notes;
        BsdfBuilder builder{&resources, {}, &notes};
        builder.nested = [&](const std::shared_ptr<const Properties>& child) {
            Bsdf inner = build_bsdf(*child, builder);
            set.push_back(std::move(inner));
            return static_cast<int>(set.size()) - 1;
        };
        Bsdf outer = build_bsdf(*node, builder);
        set.push_back(std::move(outer));
        reports.push_back({node->type, node->id, node->where, Examiner(set.back(), set).run()});
    }
    return reports;
}

}  // namespace patina::render
