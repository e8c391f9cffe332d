//! Which options of `build` have a meaning for which input and decimator.
//!
//! Nothing that is typed is ignored: an option that means nothing for any of the inputs is wrong
//! usage.

use nephrite_formats::{FileFormat, VolumeFormat};

use super::arguments::Arguments;
use crate::failure::Failure;
use crate::words::{BoundName, MethodName, PlacementName};

/// What an input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InputKind {
    Surface,
    Volume,
    /// A volume whose solutions are in files of their own.
    Plot3d,
}

impl InputKind {
    pub(super) const ALL: [Self; 3] = [Self::Surface, Self::Volume, Self::Plot3d];

    /// The kind of the inputs in a format.
    pub(super) fn of(format: FileFormat) -> Self {
        match format {
            FileFormat::Surface(_) => Self::Surface,
            FileFormat::Volume(VolumeFormat::Plot3d) => Self::Plot3d,
            FileFormat::Volume(_) => Self::Volume,
        }
    }
}

/// What an option needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Needs {
    Surface,
    Jade,
    /// JADE with vertices that may move.
    JadeCertified,
    /// JADE with one of the paper's bounds.
    JadeEstimate,
    Progressive,
    Volume,
    Plot3d,
}

impl Needs {
    fn are_met(self, method: MethodName, bound: BoundName, kind: InputKind) -> bool {
        let is_jade = kind == InputKind::Surface && method == MethodName::Jade;
        match self {
            Self::Surface => kind == InputKind::Surface,
            Self::Jade => is_jade,
            Self::JadeCertified => is_jade && bound == BoundName::Certified,
            Self::JadeEstimate => is_jade && bound != BoundName::Certified,
            Self::Progressive => kind == InputKind::Surface && method == MethodName::Progressive,
            Self::Volume => kind != InputKind::Surface,
            Self::Plot3d => kind == InputKind::Plot3d,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Surface => "a surface",
            Self::Jade => "a surface and --method jade",
            Self::JadeCertified => "a surface, --method jade and --bound certified",
            Self::JadeEstimate => "a surface, --method jade and --bound joint, removed or accumulated",
            Self::Progressive => "a surface and --method progressive",
            Self::Volume => "a volume",
            Self::Plot3d => "a PLOT3D grid",
        }
    }
}

/// Options that have a meaning for some builds only: as typed, whether given, and what they need.
fn scoped(arguments: &Arguments) -> [(&'static str, bool, Needs); 14] {
    let Arguments { method, bound, jade, fusion, progressive, .. } = arguments;
    let method_needs = if *method == Some(MethodName::Fusion) { Needs::Volume } else { Needs::Surface };
    let bound_needs = match bound {
        Some(BoundName::Joint | BoundName::Removed) => Needs::Jade,
        _ => Needs::Surface,
    };
    let placement_needs = match jade.placement {
        Some(PlacementName::Best) => Needs::JadeCertified,
        _ => Needs::Jade,
    };
    [
        ("--method", method.is_some(), method_needs),
        ("--bound", bound.is_some(), bound_needs),
        ("--placement", jade.placement.is_some(), placement_needs),
        ("--jade-k", jade.k.is_some(), Needs::Jade),
        ("--jade-c1", jade.c1.is_some(), Needs::Jade),
        ("--jade-c2", jade.c2.is_some(), Needs::Jade),
        ("--jade-aspect-loss", jade.aspect_loss.is_some(), Needs::JadeEstimate),
        ("--reduction", progressive.reduction.is_some(), Needs::Progressive),
        ("--pre-split", progressive.pre_split, Needs::Progressive),
        ("--operations", progressive.operations, Needs::Progressive),
        ("--field-weight", fusion.field_weight.is_some(), Needs::Volume),
        ("--tetrahedron-share", fusion.tetrahedron_share.is_some(), Needs::Volume),
        ("--volume-loss", fusion.volume_loss.is_some(), Needs::Volume),
        ("--solution", !fusion.solution.is_empty(), Needs::Plot3d),
    ]
}

/// Refuses options that mean nothing for any input of these kinds.
///
/// # Errors
///
/// [`Failure::Usage`].
pub(super) fn check(arguments: &Arguments, kinds: &[InputKind]) -> Result<(), Failure> {
    let (method, bound) = (arguments.method.unwrap_or_default(), arguments.bound.unwrap_or_default());
    let is_refused = |needs: Needs| !kinds.iter().any(|&kind| needs.are_met(method, bound, kind));
    let mut refused =
        scoped(arguments).into_iter().filter(|&(_, is_given, needs)| is_given && is_refused(needs));
    match refused.next() {
        Some((option, _, needs)) => Err(Failure::usage(format!("{option} needs {}", needs.words()))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::*;

    /// `build` alone, as a program.
    #[derive(Parser)]
    struct Program {
        #[command(flatten)]
        build: Arguments,
    }

    fn parse(line: &str) -> Arguments {
        let words = ["build", "in.ply", "-o", "out.neph"].into_iter().chain(line.split_whitespace());
        Program::try_parse_from(words).unwrap().build
    }

    /// Options that every build honours.
    const GENERAL: [&str; 12] = [
        "output",
        "output-dir",
        "input-format",
        "max-error",
        "levels",
        "window-levels",
        "compact",
        "feature-angle",
        "lock-boundary",
        "threads",
        "help",
        "version",
    ];

    #[test]
    fn every_option_is_general_or_has_a_scope() {
        let scoped = scoped(&parse("")).map(|(option, ..)| option);
        for argument in Program::command().get_arguments() {
            let Some(long) = argument.get_long() else { continue };
            let is_scoped = scoped.contains(&format!("--{long}").as_str());
            assert!(is_scoped != GENERAL.contains(&long), "--{long}");
        }
    }

    #[test]
    fn options_without_meaning_are_refused_by_name() {
        use InputKind::{Plot3d, Surface, Volume};
        for (line, refused_by, honoured_by) in [
            ("--method jade", &[Volume, Plot3d][..], &[Surface][..]),
            ("--method fusion", &[Surface], &[Volume, Plot3d]),
            ("--bound joint", &[Volume], &[Surface]),
            ("--bound joint --method progressive", &[Surface], &[]),
            ("--bound accumulated --method progressive", &[Volume], &[Surface]),
            ("--placement best", &[Volume], &[Surface]),
            ("--placement best --bound joint", &[Surface], &[]),
            ("--placement original --method progressive", &[Surface], &[]),
            ("--jade-k 9", &[Volume], &[Surface]),
            ("--jade-aspect-loss 0.1", &[Surface, Volume], &[]),
            ("--jade-aspect-loss 0.1 --bound removed", &[Volume], &[Surface]),
            ("--reduction 0.5", &[Surface, Volume], &[]),
            ("--operations --method progressive", &[Volume], &[Surface]),
            ("--pre-split", &[Surface], &[]),
            ("--field-weight 1", &[Surface], &[Volume, Plot3d]),
            ("--volume-loss 0.1", &[Surface], &[Volume]),
            ("--solution q", &[Surface, Volume], &[Plot3d]),
        ] {
            let arguments = parse(line);
            let option = line.split(' ').next().unwrap();
            for &kind in refused_by {
                let failure = check(&arguments, &[kind]).unwrap_err();
                assert!(failure.to_string().contains("--"), "{option}: {failure}");
                assert_eq!(failure.status(), 2);
            }
            for &kind in honoured_by {
                assert!(check(&arguments, &[kind]).is_ok(), "{line} for {kind:?}");
            }
            // In a database an option concerns the parts for which it has a meaning.
            assert_eq!(check(&arguments, &InputKind::ALL).is_ok(), !honoured_by.is_empty(), "{line}");
        }
    }
}
