//! A parameter of a material that is out of its range.

use thiserror::Error;

use crate::notation::number;

/// A parameter that is out of its range.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct ParameterError {
    /// Name of the parameter; empty if the fault lies in no single one.
    pub field: &'static str,
    /// The finding.
    pub message: String,
    /// The correction.
    pub help: String,
}

impl ParameterError {
    /// An error at a parameter.
    pub fn new(field: &'static str, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { field, message: message.into(), help: help.into() }
    }

    /// An error unless the value is finite and above zero.
    pub fn require_positive(field: &'static str, value: f64) -> Result<(), Self> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        Err(Self::new(field, format!("`{field}` must be positive, found {}", number(value)), ""))
    }

    /// An error unless the value is finite and not below zero.
    pub fn require_not_negative(field: &'static str, value: f64) -> Result<(), Self> {
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        Err(Self::new(field, format!("`{field}` must not be negative, found {}", number(value)), ""))
    }
}
