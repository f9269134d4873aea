//! The choice of a graphics adapter.

use super::GpuError;

/// Returns the adapter that the environment names, or else the fastest one, or else a software
/// adapter.
pub(crate) async fn adapter(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, GpuError> {
    if let Ok(name) = std::env::var("WGPU_ADAPTER_NAME") {
        return named_adapter(instance, surface, name).await;
    }
    let fastest = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        compatible_surface: surface,
        ..Default::default()
    };
    let software = wgpu::RequestAdapterOptions {
        force_fallback_adapter: true,
        compatible_surface: surface,
        ..Default::default()
    };
    if let Ok(adapter) = instance.request_adapter(&fastest).await {
        return Ok(adapter);
    }
    let found = instance.request_adapter(&software).await;
    found.map_err(|source| GpuError::NoAdapter { source })
}

async fn named_adapter(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
    name: String,
) -> Result<wgpu::Adapter, GpuError> {
    let wanted = name.to_lowercase();
    instance
        .enumerate_adapters(wgpu::Backends::all())
        .await
        .into_iter()
        .filter(|adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface)))
        .find(|adapter| adapter.get_info().name.to_lowercase().contains(&wanted))
        .ok_or(GpuError::NotNamed { name })
}
