#pragma once
// The report of `patina paint`: metrics of a drawdown, colour at several angles, gloss, and the distance to a target.

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "patina/brdf/mueller_table.h"
#include "patina/coating/paint_metrics.h"
#include "patina/coating/tinting_strength.h"

namespace patina::jobs {

struct PaintRequest {
    coating::PaintOptions options;  // wavelengths may be empty: 400 to 700 nm every 10 nm, or one without colour
    bool angular = true;            // the colours at several angles and the gloss too, which need the whole BRDF
    std::optional<Eigen::Vector3d> target_lab;  // L*a*b* for 45:0, D65 and 10 degrees
    std::optional<coating::Recipe> against;     // the standard of the tinting strength
    std::string command;
};

// Light at 45 degrees, seen in its plane at an angle from the mirror direction towards the normal and beyond (ASTM
// E2194).
struct AspecularColour {
    double aspecular_deg;
    std::vector<double> reflectance;  // factors, one a wavelength
    Eigen::Vector3d lab;              // D65, 10 degrees
};

// ISO 2813: unpolarized specular reflectance over that of black glass of refractive index 1.567, which has 100. Of a
// smooth surface (and the mirror below it); light scattered into the aperture is not counted.
struct Gloss {
    double theta_deg;
    double gloss_units;
};

struct PaintReport {
    coating::PaintMetrics metrics;
    std::vector<AspecularColour> aspecular;
    std::vector<Gloss> gloss;
    std::optional<Eigen::Vector3d> target_lab;
    std::optional<coating::TintingStrength> tinting_strength;
    std::optional<double> delta_e_2000;  // of 45:0 over the own base, D65 and 10 degrees
};

// The wavelengths a report uses when none are given.
std::vector<double> paint_wavelengths(const coating::Recipe& recipe, const std::vector<double>& wanted_nm);

PaintReport paint(const coating::Recipe& recipe, const PaintRequest& request, const JobControl& control = {});

// Colour of a table, 45:0, D65 and 10 degrees.
Eigen::Vector3d lab_45_0(const brdf::MuellerTable& table);

std::vector<AspecularColour> aspecular_colours(const brdf::MuellerTable& table);
std::vector<Gloss> gloss(const brdf::MuellerTable& table);

}  // namespace patina::jobs
