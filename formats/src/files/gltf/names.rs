//! Attribute semantics of glTF and the names of attributes here.

/// The name that an attribute gets; `None` for a semantic that glTF does not define.
pub(crate) fn attribute_name(semantic: &str) -> Option<String> {
    if let Some(name) = semantic.strip_prefix('_').filter(|name| !name.is_empty()) {
        return Some(name.into());
    }
    match semantic {
        "NORMAL" | "TANGENT" => return Some(semantic.to_ascii_lowercase()),
        "TEXCOORD_0" => return Some("texcoord".into()),
        "COLOR_0" => return Some("color".into()),
        _ => {}
    }
    let (kind, set) = semantic.split_once('_')?;
    let is_set = !set.is_empty() && set.bytes().all(|byte| byte.is_ascii_digit());
    let is_known = matches!(kind, "TEXCOORD" | "COLOR" | "JOINTS" | "WEIGHTS");
    (is_set && is_known).then(|| semantic.to_ascii_lowercase())
}

/// A semantic of glTF that an attribute's name stands for, without its set number, and the full
/// semantic.
pub(crate) fn semantic(name: &str) -> Option<(&'static str, String)> {
    match name {
        "normal" => return Some(("NORMAL", "NORMAL".into())),
        "tangent" => return Some(("TANGENT", "TANGENT".into())),
        "texcoord" => return Some(("TEXCOORD", "TEXCOORD_0".into())),
        "color" => return Some(("COLOR", "COLOR_0".into())),
        _ => {}
    }
    let (kind, _) = name.split_once('_')?;
    let full = name.to_ascii_uppercase();
    let kind = match kind {
        "texcoord" => "TEXCOORD",
        "color" => "COLOR",
        "joints" => "JOINTS",
        "weights" => "WEIGHTS",
        _ => return None,
    };
    (attribute_name(&full).as_deref() == Some(name)).then_some((kind, full))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_semantics_match() {
        for name in
            ["normal", "tangent", "texcoord", "texcoord_1", "color", "color_12", "joints_0", "weights_0"]
        {
            let (_, full) = semantic(name).unwrap();
            assert_eq!(attribute_name(&full).as_deref(), Some(name));
        }
        assert_eq!(attribute_name("_TEMPERATURE").as_deref(), Some("TEMPERATURE"));
        for semantic in ["NORMAL_1", "TEXCOORD_", "TEXCOORD_x", "FOO", "", "_"] {
            assert_eq!(attribute_name(semantic), None, "{semantic}");
        }
        for name in ["label", "texcoord_0", "texcoord_x", "joints", "normal_1"] {
            assert_eq!(semantic(name), None, "{name}");
        }
    }
}
